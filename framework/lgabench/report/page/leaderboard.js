
// What a leaderboard's page does: rows are filtered, and a click on a number shows an entry's episodes.
const many = 1000;  // a data-row is the entry's number times this, and its scenario's + 1

// One filter for a page's rankings and their scenarios: rows that have all of the words. A word that some row has as it
// stands is a whole one: "lga" does not find LGA-S. Without words, the best row of each method, or all.
const boards = [...document.querySelectorAll("[id^=table] table.sortable")]
  .filter((table) => !table.closest("section").id.includes("-") || table.closest("section").id.endsWith("-scenarios"));
if (boards.length) {
  const rows = boards.flatMap((table) => [...table.tBodies].flatMap((body) => [...body.rows]));
  const wordsOf = (row) => [...row.cells].map((cell) => cell.textContent).join(" ").toLowerCase().split(/[\s,;]+/);
  const wanted = document.createElement("input"), all = document.createElement("input"), label = document.createElement("label");
  wanted.type = "search";
  wanted.placeholder = wanted.ariaLabel = "Find rows: words of their names";
  all.type = "checkbox";
  const apply = () => {
    const said = wanted.value.toLowerCase().split(/\s+/).filter((word) => word);
    const known = rows.map((row) => [row, wordsOf(row)]);
    const whole = said.filter((word) => known.some(([, words]) => words.includes(word)));
    for (const [row, words] of known)
      row.hidden = said.length
        ? !said.every((word) => words.some((one) => whole.includes(word) ? one === word : one.includes(word)))
        : row.classList.contains("more") && !all.checked;
  };
  const more = boards.filter((table) => !table.closest("section").id.includes("-"))
    .flatMap((table) => [...table.querySelectorAll("tr.more")]).length;
  label.append(all, more ? ` all rows (${more} more), not only the best of each method` : "");
  label.hidden = !more;
  wanted.oninput = all.onchange = apply;
  const box = document.createElement("p");
  box.className = "filter";
  box.append(wanted, label);
  boards[0].closest(".frame").before(box);
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

function fill(body, entry, setting, scenario) {
  const won = successes(entry.successes), failed = new Map(entry.failed), lines = [];
  placesOf(setting, entry.learns).forEach((place, i) => {
    if (place.scenario !== scenario) return;
    const episodes = Array.from({ length: setting.episodes }, (_, k) => won(i * setting.episodes + k));
    const count = episodes.reduce((sum, one) => sum + one, 0);
    lines.push(`<tr>${[place.layout, place.arm, place.n, place.seed].map((text) => `<td>${escaped(text)}</td>`).join("")}` +
      `<td>${count} of ${episodes.length}</td><td>${failed.has(place.cell) ? escaped("the method failed: " + failed.get(place.cell)) : strip(episodes)}</td></tr>`);
  });
  body.innerHTML = `<p>The same cells again, one of them with <code>--demos N --seeds S</code>` +
    `${entry.learns ? ", a method of your own with <code>--plugin-path</code>" : ""}:</p>` +
    `<pre>${escaped(`${entry.command} --scenarios ${scenario} --out again`)}</pre>` +
    `<p>Why each episode failed, and everything else: <a href="${escaped(entry.place)}/cells.jsonl">cells.jsonl</a>, ` +
    `<a href="${escaped(entry.place)}/entry.json">entry.json</a>` +
    `${entry.kept_answers ? `, <a href="${escaped(entry.kept_answers)}">the answers</a>` : ""}.</p>` +
    `<div class="frame"><table><caption>Episodes in their order: a whole bar is a success</caption><thead><tr>` +
    ["layout", "arm", "demonstrations", "training seed", "successes", "episodes"].map((head) => `<th scope="col">${head}</th>`).join("") +
    `</tr></thead><tbody>${lines.join("")}</tbody></table></div>`;
}

function show(row) {
  const entry = data.entries[Math.floor(row / many)];
  if (!entry) return;
  const setting = data.settings[entry.table], at = Math.max(0, row % many - 1);
  $("panel-title").textContent = entry.name;
  const facts = [["options", entry.row], ["authors", entry.authors.join(", ")], ["license", entry.license], ["source", entry.source],
    ["version", entry.version], ["answers", entry.answers], ["computed by", entry.program], ["processor", entry.processor],
    ["tier", entry.tier], ["id", entry.id]];
  const body = document.createElement("div"), about = document.createElement("dl"), choice = $("outcome");
  about.innerHTML = facts.map(([name, value]) => `<dt>${name}</dt><dd>${escaped(value)}</dd>`).join("");
  choice.innerHTML = setting.scenarios.map((one, i) => `<option${i === at ? " selected" : ""} value="${escaped(one.id)}">${escaped(words(one.id))}</option>`).join("");
  choice.onchange = () => {
    fill(body, entry, setting, choice.value);
    fit(body);
  };
  $("panel-body").replaceChildren(about, body);
  for (const [id, step] of [["previous", -many], ["next", many]]) {
    $(id).disabled = !data.entries[Math.floor((row + step) / many)];
    $(id).onclick = () => show(row + step);
  }
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
