
// What a leaderboard's pages do: rankings are tabs, rows are filtered, and a click on a number shows an entry's episodes.
const many = 1000;  // a data-row is the entry's number times this, and its scenario's + 1

// One ranking at a time: its sections, and their names above.
const sectionsOf = ({ sections: [id] }) => [...document.querySelectorAll("main section")]
  .filter((section) => section.id === id || section.id.startsWith(`${id}-`) && !data.tabs.some((tab) => tab.sections[0] === section.id));
const tabs = document.createElement("div");
function choose(chosen) {
  data.tabs.forEach((tab, i) => {
    const button = tabs.children[i];
    button.setAttribute("aria-selected", i === chosen);
    button.tabIndex = i === chosen ? 0 : -1;
    sectionsOf(tab).forEach((section) => {
      section.hidden = i !== chosen;
      document.querySelector(`#contents a[href="#${section.id}"]`).hidden = i !== chosen;
    });
  });
  fit();
}
if (data.tabs.length > 1) {
  tabs.className = "tabs";
  tabs.setAttribute("role", "tablist");
  tabs.ariaLabel = "Rankings";
  data.tabs.forEach(({ title }, i) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = title;
    button.setAttribute("role", "tab");
    button.onclick = () => choose(i);
    tabs.append(button);
  });
  tabs.onkeydown = ({ key }) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[key], now = [...tabs.children].indexOf(document.activeElement);
    if (!step || now < 0) return;
    const next = (now + step + data.tabs.length) % data.tabs.length;
    choose(next);
    tabs.children[next].focus();
  };
  sectionsOf(data.tabs[0])[0].before(tabs);
  choose(0);
}

// Ranks count all rows: where hidden ones stand between two ranks, the lower says so.
function explainRanks(rows, rankOf) {
  let before = "", hidden = 0;
  for (const row of rows) {
    const rank = rankOf(row);
    if (!(rank > 0)) continue;
    hidden += row.hidden;
    delete row.cells[0].dataset.hidden;
    if (row.hidden) continue;
    if (hidden && rank !== before) {
      row.cells[0].dataset.hidden = `after ${hidden} hidden`;
      hidden = 0;
    }
    before = rank;
  }
}

// One filter for a page's tables: rows that have all of the words, and the chosen policy, answers and suite. A word that some
// row has as it stands is a whole one: "lga" does not find LGA-S. Without words, each method's best row, trained and
// untrained, or all.
const boards = [...document.querySelectorAll("[id^=table] table.sortable, [id^=overview] table")]
  .filter((table) => !/^table.*-(answers|curves)$/.test(table.closest("section").id));
if (boards.length) {
  const rows = boards.flatMap((table) => [...table.tBodies].flatMap((body) => [...body.rows]));
  const heads = new Map(boards.map((table) => [table, [...table.querySelectorAll("thead th")].map((head) => head.textContent)]));
  const valueOf = (row, head) => {
    const at = heads.get(row.closest("table")).indexOf(head);
    return at < 0 ? null : row.cells[at].textContent;
  };
  const wordsOf = (row) => `${valueOf(row, "method")} ${valueOf(row, "policy")}`.toLowerCase().split(/[\s,;]+/);
  const wanted = document.createElement("input"), all = document.createElement("input"), label = document.createElement("label");
  wanted.type = "search";
  wanted.placeholder = wanted.ariaLabel = "Find rows: words of their names";
  all.type = "checkbox";
  const choices = ["policy", "answers"].map((head) => {
    const choice = document.createElement("select"), values = [...new Set(rows.map((row) => valueOf(row, head)))].filter((value) => value).sort();
    choice.ariaLabel = head;
    choice.innerHTML = `<option value="">${head}: all</option>` + values.map((value) => `<option>${escaped(value)}</option>`).join("");
    choice.hidden = values.length < 2 || !boards.every((table) => heads.get(table).includes(head));
    return [head, choice];
  });
  // A suite of the first page is a column: it alone is shown, with the rows that are in it, by their success there.
  const suites = document.createElement("select"), titles = boards.filter((table) => table.closest("[id^=overview]"))
    .flatMap((table) => heads.get(table).slice(3, -1));
  suites.ariaLabel = "suite";
  suites.innerHTML = "<option value=''>suite: all</option>" + [...new Set(titles)].map((title) => `<option>${escaped(title)}</option>`).join("");
  suites.hidden = !titles.length;
  const bodies = boards.flatMap((table) => [...table.tBodies]).map((body) => [body, [...body.rows]]);
  suites.onchange = () => {
    for (const [body, order] of bodies) {
      const table = body.parentElement, at = heads.get(table).indexOf(suites.value);
      const success = (row) => parseFloat(row.cells[at].textContent) || 0;
      body.append(...(at < 0 ? order : [...order].sort((a, b) => success(b) - success(a))));
      for (const row of table.rows)
        [...row.cells].forEach((cell, i) => { cell.hidden = at >= 0 && i > 2 && i !== at; });
      table.querySelectorAll("[aria-sort]").forEach((head) => head.removeAttribute("aria-sort"));
      if (at >= 0) table.tHead.rows[0].cells[at].setAttribute("aria-sort", "descending");
    }
    apply();
    fit();
  };
  const more = [...document.querySelectorAll(":is([id^=table]:not([id*='-']), [id^=overview]) > .frame tr.more")].length;
  const apply = () => {
    const said = wanted.value.toLowerCase().split(/[\s_]+/).filter((word) => word);
    const known = rows.map((row) => [row, wordsOf(row)]);
    const whole = said.filter((word) => known.some(([, words]) => words.includes(word)));
    const chosen = choices.filter(([, choice]) => choice.value), found = said.length || chosen.length || suites.value;
    label.hidden = !more || found;  // what is found is shown whole
    for (const [row, words] of known)
      row.hidden = found
        ? !said.every((word) => words.some((one) => whole.includes(word) ? one === word : one.includes(word))) ||
          chosen.some(([head, choice]) => valueOf(row, head) !== choice.value) || valueOf(row, suites.value) === "–"
        : row.classList.contains("more") && !all.checked;
    for (const table of boards) explainRanks(rows.filter((row) => row.closest("table") === table), (row) => valueOf(row, "rank"));
  };
  const first = document.querySelector("[id^=overview]") ? "those of half of the suites" : "each method’s best, trained and untrained";
  label.append(all, more ? ` all rows (${more} more), not only ${first}` : "");
  wanted.oninput = all.onchange = apply;
  choices.forEach(([, choice]) => { choice.onchange = apply; });
  const box = document.createElement("p");
  box.className = "filter";
  box.append(wanted, suites, ...choices.map(([, choice]) => choice), label);
  data.tabs.length > 1 ? tabs.after(box) : boards[0].closest(".frame").before(box);
  apply();
}

// Cells of a table in the order of their bits: [scenario, layout, demonstrations, training seed, arm].
function placesOf(setting, learns) {
  const all = [], sets = setting.test_scenes === "per_seed" ? setting.seeds : [0];
  let cell = 0;
  for (const scenario of setting.scenarios)
    for (const layout of setting.layouts)
      for (const n of learns ? setting.demonstrations : [0])
        for (const seed of learns ? setting.seeds : sets) {
          for (const arm of scenario.arms) all.push({ scenario: scenario.id, layout, n, seed, arm, cell });
          cell += 1;
        }
  return all;
}

const successes = (text) => {
  const bytes = atob(text);
  return (i) => (bytes.charCodeAt(i >> 3) >> (7 - i % 8)) & 1;
};

// An episode is a bar: whole for a success, a stump for a failure.
function strip(won) {
  const bars = won.map((one, i) => one ? `M${i * 3} 0h2v12h-2z` : `M${i * 3} 9h2v3h-2z`).join("");
  const count = won.reduce((sum, one) => sum + one, 0);
  return `<svg class="strip" viewBox="0 0 ${won.length * 3} 12" width="${won.length * 3}" height="12" role="img" ` +
    `aria-label="${count} of ${won.length} succeeded"><path d="${bars}"/></svg>`;
}

// The worst and the best scene of an entry, made again by a replay: those of the scenario, and buttons that lead to others.
function pictures(entry, setting, scenario) {
  if (!entry.scenes.length) return `<p>No pictures yet: <code>lgabench leaderboard scenes ${entry.id}</code> makes two.</p>`;
  const titleOf = (one) => setting.scenarios.find(({ id }) => id === one.scenario).title;
  const end = (one) => one.which === "best" ? "Where it does best" : "Where it does worst";
  const own = entry.scenes.filter((one) => one.scenario === scenario);
  const others = entry.scenes.filter((one) => one.scenario !== scenario).map((one) =>
    `<button type="button" data-scenario="${escaped(one.scenario)}">${end(one)}: ${escaped(titleOf(one))}</button>`).join(" ");
  const where = (one) => `${titleOf(one)}, ${setting.titles[one.arm]}, ${one.n ? `${one.n} demonstration${one.n > 1 ? "s" : ""}, ` : ""}training seed ${one.seed}, scene ${one.index}`;
  return `<div class="scenes">` + own.map((one) =>
    `<figure><img src="${escaped(one.picture)}" width="516" height="128" alt="${escaped(`${one.command} ${words(one.outcome)}`)}">` +
    `<figcaption>${end(one)}: <b>${escaped(words(one.outcome))}</b><br>` +
    `${escaped(one.command)}<small>${escaped(where(one))}</small></figcaption></figure>`).join("") + "</div>" +
    (own.length ? `<p><small>Left: before, the target outlined, the action from the ring to the line’s end. Right: after.</small></p>` : "") +
    (others ? `<p>${own.length ? "Another scenario" : "Pictures of other scenarios"}: ${others}</p>` : "");
}

function fill(body, entry, setting, scenario) {
  const won = successes(entry.successes), failed = new Map(entry.failed), lines = [];
  placesOf(setting, entry.learns).forEach((place, i) => {
    if (place.scenario !== scenario) return;
    const episodes = Array.from({ length: setting.episodes }, (_, k) => won(i * setting.episodes + k));
    const count = episodes.reduce((sum, one) => sum + one, 0);
    lines.push(`<tr>${[words(place.layout), setting.titles[place.arm], place.n, place.seed].map((text) => `<td>${escaped(text)}</td>`).join("")}` +
      `<td>${count} of ${episodes.length}</td><td>${failed.has(place.cell) ? escaped("the method failed: " + failed.get(place.cell)) : strip(episodes)}</td></tr>`);
  });
  body.innerHTML = `<p>The same cells again, one of them with <code>--demos N --seeds S</code>` +
    `${entry.learns ? ", a method of your own with <code>--plugin-path</code>" : ""}:</p>` +
    `<pre>${escaped(`${entry.command} --scenarios ${scenario} --out again`)}</pre>` +
    `<p>Then <code>again/report.html</code> shows all of their scenes. Why each episode failed, and everything else: <a href="${escaped(entry.place)}/cells.jsonl">cells.jsonl</a>, ` +
    `<a href="${escaped(entry.place)}/entry.json">entry.json</a>` +
    `${entry.kept_answers ? `, <a href="${escaped(entry.kept_answers)}">the answers</a>` : ""}.</p>` +
    `<div class="frame"><table><caption>Episodes in their order: a whole bar is a success</caption><thead><tr>` +
    ["layout", "arm", "demonstrations", "training seed", "successes", "episodes"].map((head) => `<th scope="col">${head}</th>`).join("") +
    `</tr></thead><tbody>${lines.join("")}</tbody></table></div>`;
}

function show(row) {
  const entry = data.entries[Math.floor(row / many)];
  if (!entry) return;
  const setting = data.settings[entry.table];
  const at = row % many ? row % many - 1 : Math.max(0, setting.scenarios.findIndex(({ id }) => id === entry.scenes[0]?.scenario));
  $("panel-title").textContent = entry.name;
  const link = ({ text, url }) => url ? `<a href="${escaped(url)}">${escaped(text)}</a>` : `<code>${escaped(text)}</code>`;
  const code = (text) => `<code>${escaped(text)}</code>`;
  const facts = [["options", code(entry.row)], ["authors", escaped(entry.authors.join(", "))], ["license", escaped(entry.license)],
    ["source", link(entry.source)], ["version", escaped(entry.version)], ["answers", code(entry.answers)],
    ["computed", `${escaped(entry.computed)}, by ${code(entry.program)}`], ["replayed", escaped(entry.replayed)],
    ["processor", escaped(entry.processor)], ["tier", escaped(entry.tier)], ["id", code(entry.id)],
    ...(entry.supersedes || []).map(({ when, reason, place }) => ["superseded", `${escaped(when)}: <a href="${escaped(place)}/cells.jsonl">the cells before</a>; ${escaped(reason)}`])];
  const body = document.createElement("div"), about = document.createElement("dl"), choice = $("outcome");
  about.innerHTML = facts.map(([name, value]) => `<dt>${name}</dt><dd>${value}</dd>`).join("");
  choice.innerHTML = setting.scenarios.map((one, i) => `<option${i === at ? " selected" : ""} value="${escaped(one.id)}">${escaped(one.title)}</option>`).join("");
  const seen = document.createElement("div");
  choice.onchange = () => {
    seen.innerHTML = pictures(entry, setting, choice.value);
    fill(body, entry, setting, choice.value);
    fit(body);
  };
  seen.onclick = ({ target }) => {
    if (!target.dataset.scenario) return;
    choice.value = target.dataset.scenario;
    choice.onchange();
    choice.focus();
  };
  $("panel-body").replaceChildren(seen, about, body);
  for (const [id, step] of [["previous", -many], ["next", many]]) {
    $(id).disabled = !data.entries[Math.floor((row + step) / many)];
    $(id).onclick = () => show(row + step);
  }
  if (data.tabs.length > 1) choose(entry.table);
  tip.hidden = true;
  if (!$("panel").open) $("panel").showModal();
  choice.onchange();
  $("panel").scrollTop = 0;
  history.replaceState(null, "", `#row=${row}`);
}

$("previous").textContent = "Entry before";
$("next").textContent = "Next entry";
$("all").hidden = true;
$("outcome").ariaLabel = "Scenario";
$("panel").onclose = () => history.replaceState(null, "", location.pathname + location.search);
document.addEventListener("click", (event) => {
  const number = event.target.closest("[data-row]");
  if (number) show(Number(number.dataset.row));
});
const linked = /^#row=(\d+)$/.exec(location.hash);
if (linked) show(Number(linked[1]));
