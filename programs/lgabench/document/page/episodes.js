
// The dialog: the episodes of a row of summary.json, and one of them.
const episodeId = (e) => `${e.cell.cell}/${e.arm}/${e.index}`;

function episodesOf(row) {
  const all = [];
  for (const cell of data.cells)
    for (const played of cell.arms)
      if (played.rows.includes(row))
        [...played.outcomes].forEach((outcome, index) => {
          const command = played.commands[index], scene = data.scenes[played.scenes][index];
          const to = played.attribution[index];
          all.push({
            cell, arm: played.arm, index, scene, command: cell.commands[command],
            failure: outcome === "." ? "" : words(data.failures[outcome.charCodeAt(0) - 97]),
            attribution: to === "a" ? "abstraction" : to === "p" ? "policy" : to === "s" ? "perception" : to === "r" ? "reading" : "",
            action: played.actions[index], then: played.then?.[index] || [], picture: data.pictures[scene], end: played.ends[index],
            oracle: data.oracle[scene], targets: data.targets[scene],
            mask: cell.masks[command] && data.masks[scene + cell.masks[command]],
            input: data.inputs[played.read[index]],
            phi: data.phi[cell.phi[command]],
          });
        });
  return all.sort((a, b) => !a.failure - !b.failure);
}

// A PNG's width and height, from its header.
function sizeOf(base64) {
  const bytes = Uint8Array.from(atob(base64.slice(0, 32)), (c) => c.charCodeAt(0)), view = new DataView(bytes.buffer);
  return [view.getUint32(16), view.getUint32(20)];
}

function picture(bytes, alt, over = "") {
  const [width, height] = sizeOf(bytes);
  return `<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="${escaped(alt)}">` +
    `<image href="data:image/png;base64,${bytes}" width="${width}" height="${height}"/>${over}</svg>`;
}

// From the action's first place to its last, if it has two, on black, so that it shows on every texture.
function arrow(action, colour, dashes = "none") {
  if (!action?.length) return "";
  const [x0, y0] = action[0], [x1, y1] = action[action.length - 1], angle = Math.atan2(y1 - y0, x1 - x0);
  const wing = (turn) => `${x1 - 9 * Math.cos(angle + turn)} ${y1 - 9 * Math.sin(angle + turn)}`;
  const way = `M${x0} ${y0}L${x1} ${y1}`, head = action.length < 2 ? "" : `M${wing(.5)}L${x1} ${y1}L${wing(-.5)}`;
  return `<g fill="none" stroke-linecap="round"><path d="${way}${head}" stroke="#000" stroke-width="4"/>` +
    `<path d="${way}" stroke="${colour}" stroke-width="1.8" stroke-dasharray="${dashes}"/>` +
    `<path d="${head}" stroke="${colour}" stroke-width="1.8"/>` +
    `<circle cx="${x0}" cy="${y0}" r="3.5" fill="${colour}" stroke="#000" stroke-width="1.2"/></g>`;
}
const own = (e) => arrow(e.action, "#fff");
const oracle = (e) => arrow(e.oracle, "#5dff8f", "5 4");
const outline = (e) => e.targets ? `<g fill="none"><path d="${e.targets}" stroke="#000" stroke-width="2.6"/>` +
  `<path d="${e.targets}" stroke="#ffe100" stroke-width="1.3"/></g>` : "";

const meaning = { better: "selected and true", missed: "missed", worse: "selected, not true" };
const chips = (e) => !e.phi.length ? "" : `<div class="chips">` + e.phi.map(([what, kind, names]) =>
  `<span class="${kind}" title="${escaped(what)}: ${meaning[kind]}">${escaped(names)}</span>`).join("") + `</div>`;

const whose = (e) => e.cell.participant && `, participant ${e.cell.participant}`;
const where = (e) => `${words(e.cell.scenario)}, ${data.arms[e.arm]}, scene ${e.index}, training seed ${e.cell.seed}${whose(e)}`;
const wayOf = (name, action) => action ? `, ${name} from ${action.map((place) => place.join(",")).join(" to ")}` : `, no ${name}`;
const told = (e) => `<b>${e.failure || "success"}</b>${e.attribution ? `, attributed to the ${e.attribution}` : ""}`;

// An arrow that is cut off says so.
const leaves = (e) => {
  const [width, height] = sizeOf(e.picture);
  return (e.action || []).some(([x, y]) => x < 0 || y < 0 || x > width || y > height) ? " The action leaves the picture." : "";
};

const before = (e) => picture(e.picture, `before: ${where(e)}${wayOf("action", e.action)}${wayOf("oracle", e.oracle)}`,
  outline(e) + oracle(e) + own(e));
const kept = (e) => e.mask ? picture(e.mask, `goal mask: ${where(e)}`, outline(e) + own(e)) : "";
// How an episode of one action ended; none of several.
const after = (e) => typeof e.end !== "string" ? "" : picture(e.end || e.picture, `after the action: ${where(e)}`);

// An episode of several steps, a step at a time: a picture before each action, which is drawn in it, and at the end. The
// slider says which of them is shown, at first the end.
function steps(e) {
  if (!Array.isArray(e.end)) return "";
  const pictures = [e.picture, ...e.end.map((end) => end || e.picture)], last = e.end.length;
  const names = pictures.map((bytes, i) => i === 0 ? `before step 1 of ${last}` :
    `after step ${i} of ${last}${bytes === pictures[i - 1] ? ": nothing moved" : ""}`);
  const shown = pictures.map((bytes, i) => `<span data-name="${names[i]}"${i === last ? "" : " hidden"}>` +
    `${picture(bytes, `${names[i]}: ${where(e)}`, i === last ? "" : arrow([e.action, ...e.then][i], "#fff"))}</span>`);
  return `<figure class="stepwise"><button type="button" class="zoom" aria-pressed="false">${shown.join("")}</button>` +
    `<input type="range" min="0" max="${last}" value="${last}" aria-label="Step" aria-valuetext="${names[last]}">` +
    `<figcaption>${names[last]}</figcaption></figure>`;
}
function showStep(slider) {
  const figure = slider.closest(".stepwise"), all = [...figure.querySelectorAll("[data-name]")], now = all[slider.valueAsNumber];
  for (const one of all) one.hidden = one !== now;
  slider.setAttribute("aria-valuetext", figure.querySelector("figcaption").textContent = now.dataset.name);
}

const card = (e) =>
  `<figure><button type="button" class="zoom" data-episode="${escaped(episodeId(e))}"><span class="pair">` +
  `${before(e)}${kept(e)}</span></button><figcaption>${told(e)}<br>${escaped(e.command)}${chips(e)}` +
  `<small>${escaped(where(e))}</small></figcaption></figure>`;

// What the policy acted on, at its size, and in words what of it is no picture.
const saw = (e) => !e.input ? [] : e.input.pictures.map(([name, number]) =>
  [`what the policy saw: ${escaped(name)}`, picture(data.seen[number], `what the policy saw: ${name}; ${where(e)}`)]);
const joined = (all) => all.length < 2 ? all.join("") : `${all.slice(0, -1).join(", ")} and ${all.at(-1)}`;
function read(e) {
  if (!e.input) return "";
  const { pictures } = e.input, [texts, unread] = [e.input.texts, e.input.unread].map((all) => all.map(escaped));
  const also = texts.length ? `The policy read ${joined(texts)}${pictures.length ? " as well" : " alone"}, as a sentence embedding. ` : "";
  return also || unread.length ? `<p>${also}${unread.length ? `It did not read: ${joined(unread)}.` : ""}</p>` : "";
}

// One episode, as large as the dialog.
function single(e) {
  const signs = [[e.action?.length, "the action is white"], [e.oracle?.length, "the oracle’s green"], [e.targets, "the target outlined"]]
    .filter(([drawn]) => drawn).map(([, words]) => words).join(", ");
  const figures = (all) => all.filter(([, drawn]) => drawn).map(([name, drawn]) =>
    `<figure><button type="button" class="zoom" aria-pressed="false">${drawn}</button><figcaption>${name}</figcaption></figure>`).join("");
  const first = [[signs ? `before: ${signs}` : "before", before(e)], [e.end === "" ? "after the action: nothing moved" : "after the action", after(e)]];
  return `<p>${told(e)}. ${escaped(e.command)}${leaves(e)} <small>${escaped(where(e))}</small></p>${chips(e)}<div class="large">` +
    figures(first) + steps(e) + figures([["goal mask: what φ̂ keeps of the scene", kept(e)], ...saw(e)]) +
    `</div>${read(e)}<p>Again, as an animation: <code>lgabench replay RUN ${escaped(episodeId(e))} --out episode.gif</code></p>`;
}

function listOf(shown) {
  const seen = shown.filter((e) => e.picture), list = document.createElement("div");
  list.innerHTML = `<p>${shown.length} episodes, ${shown.filter((e) => e.failure).length} failed; ${seen.length} with a ` +
    "picture on this page. " + (seen.some((e) => e.action) ? "White: the action, from where it takes hold to where it lets go; " +
    "green: the oracle’s; outlined: the target. " : "Outlined: the target. ") + "A click enlarges.</p>";
  if (seen.length) list.append(growing(seen, 12, (some) => `<div class="scenes">${some.map(card).join("")}</div>`));
  const line = (e) => `<tr>${[words(e.cell.scenario), data.arms[e.arm], e.cell.seed + whose(e), e.index, e.command, e.failure || "success", e.attribution]
    .map((text) => `<td>${escaped(text)}</td>`).join("")}</tr>`;
  list.append(growing(shown, 100, (some) =>
    `<div class="frame" tabindex="0" role="region" aria-label="Episodes"><table><caption>Episodes, the failed ones first</caption><thead><tr>` +
    ["scenario", "arm", "training seed", "scene", "command", "outcome", "attributed to"]
      .map((head) => `<th scope="col">${head}</th>`).join("") +
    `</tr></thead><tbody>${some.map(line).join("")}</tbody></table></div>`));
  return list;
}

// What the dialog shows, which its address says too: #row=3&outcome=missed%20object&episode=KEY/ARM/INDEX
const panel = $("panel"), body = $("panel-body");
let now = { row: 0, outcome: "", episode: "" };
const shownOf = ({ row, outcome }) => episodesOf(row).filter((e) => !outcome || (e.failure || "success") === outcome);

function show(row, outcome = "", episode = "") {
  now = { row, outcome, episode };
  const all = episodesOf(row), counts = new Map(), shown = shownOf(now);
  for (const e of all) counts.set(e.failure || "success", (counts.get(e.failure || "success") || 0) + 1);
  const one = shown.find((e) => episodeId(e) === episode);
  $("panel-title").textContent = data.titles[row];
  $("outcome").innerHTML = `<option value="">all outcomes</option>` + [...counts].map(([word, n]) =>
    `<option${word === outcome ? " selected" : ""} value="${escaped(word)}">${escaped(word)} (${n})</option>`).join("");
  $("all").hidden = !one;
  $("previous").textContent = one ? "Previous episode" : "Previous row";
  $("next").textContent = one ? "Next episode" : "Next row";
  if (one) body.innerHTML = single(one);
  else body.replaceChildren(listOf(shown));
  tip.hidden = true;
  if (!panel.open) panel.showModal();
  panel.scrollTop = 0;
  const part = (name, value) => value ? `&${name}=${encodeURIComponent(value)}` : "";
  history.replaceState(null, "", `#row=${row}${part("outcome", outcome)}${part("episode", one && episode)}`);
}

// To the episode with a picture, or the row, before or after.
function step(by) {
  if (!now.episode) return data.titles[now.row + by] && show(now.row + by, now.outcome);
  const seen = shownOf(now).filter((e) => e.picture), next = seen[seen.findIndex((e) => episodeId(e) === now.episode) + by];
  if (next) show(now.row, now.outcome, episodeId(next));
}
$("previous").onclick = () => step(-1);
$("next").onclick = () => step(1);
$("all").onclick = () => show(now.row, now.outcome);
$("outcome").onchange = () => show(now.row, $("outcome").value);
panel.onkeydown = (event) => {
  const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (by && !["SELECT", "INPUT"].includes(event.target.tagName)) step(by);
};
body.oninput = (event) => showStep(event.target);
body.onclick = (event) => {
  const zoom = event.target.closest(".zoom");
  if (!zoom) return;
  if (zoom.dataset.episode) {
    show(now.row, now.outcome, zoom.dataset.episode);
    $("all").focus();
  } else {
    zoom.setAttribute("aria-pressed", zoom.getAttribute("aria-pressed") !== "true");
  }
};
panel.onclose = () => history.replaceState(null, "", location.pathname + location.search);

const linked = new URLSearchParams(location.hash.slice(1));
if (data.titles[linked.get("row")])
  show(Number(linked.get("row")), linked.get("outcome") || "", linked.get("episode") || "");

for (const number of document.querySelectorAll("[data-row]")) {
  const open = () => show(Number(number.dataset.row), number.dataset.outcome || "");
  number.addEventListener("click", open);
  if (!(number instanceof HTMLButtonElement))
    number.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") event.preventDefault(), open();
    });
}
