"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const words = (text) => text.replaceAll("_", " ");

// Dark or light: the system's wish until the button is pressed.
$("theme").hidden = false;
$("theme").onclick = () => {
  const root = document.documentElement;
  const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  root.dataset.theme = dark ? "light" : "dark";
};

$("contents").hidden = false;
$("contents").innerHTML = [...document.querySelectorAll("main section")]
  .map((section) => `<a href="#${section.id}">${section.querySelector("h2").textContent}</a>`).join("");

// Numbers sort as numbers, what has none goes last.
for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.querySelectorAll("thead th")];
  heads.forEach((head, column) => {
    head.innerHTML = `<button type="button">${head.innerHTML}</button>`;
    head.firstChild.onclick = () => {
      const descending = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", descending ? "descending" : "ascending");
      const key = (row) => row.cells[column].textContent.trim();
      const rows = [...table.tBodies[0].rows];
      rows.sort((a, b) => {
        const [x, y] = [key(a), key(b)], [m, n] = [parseFloat(x), parseFloat(y)];
        if (isNaN(m) !== isNaN(n)) return isNaN(m) ? 1 : -1;
        return (isNaN(m) ? x.localeCompare(y) : m - n) * (descending ? -1 : 1);
      });
      table.tBodies[0].append(...rows);
    };
  });
}

// A point's numbers, under the pointer or the focus.
const tip = $("tip");
for (const point of document.querySelectorAll(".point[aria-label]")) {
  const show = () => {
    const box = point.getBoundingClientRect();
    tip.textContent = point.getAttribute("aria-label");
    tip.hidden = false;
    tip.style.left = `${Math.max(4, Math.min(box.right + 8, innerWidth - tip.offsetWidth - 4))}px`;
    tip.style.top = `${Math.max(4, box.top - tip.offsetHeight - 4)}px`;
  };
  point.onmouseenter = point.onfocus = show;
  point.onmouseleave = point.onblur = () => { tip.hidden = true; };
}

// Episodes of a row of summary.json, over its cells.
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
            attribution: to === "a" ? "abstraction" : to === "p" ? "policy" : to === "s" ? "perception" : "",
            action: played.actions[index], picture: data.pictures[scene],
            mask: cell.masks[command] && data.masks[scene + cell.masks[command]],
            phi: data.phi[cell.phi[command]],
          });
        });
  return all;
}

const picture = (bytes, alt, over) =>
  `<svg viewBox="0 0 ${data.size.join(" ")}" role="img" aria-label="${escaped(alt)}">` +
  `<image href="data:image/png;base64,${bytes}" width="${data.size[0]}" height="${data.size[1]}"/>${over}</svg>`;

// From the action's first place to its last, if it has two, white on black, so that it shows on every texture.
function arrow(action) {
  if (!action) return "";
  const [x0, y0] = action[0], [x1, y1] = action[action.length - 1], angle = Math.atan2(y1 - y0, x1 - x0);
  const wing = (turn) => `${x1 - 9 * Math.cos(angle + turn)} ${y1 - 9 * Math.sin(angle + turn)}`;
  const path = action.length < 2 ? "" : `M${x0} ${y0}L${x1} ${y1}M${wing(.5)}L${x1} ${y1}L${wing(-.5)}`;
  return `<g fill="none" stroke-linecap="round"><path d="${path}" stroke="#000" stroke-width="4.5"/>` +
    `<path d="${path}" stroke="#fff" stroke-width="2"/>` +
    `<circle cx="${x0}" cy="${y0}" r="3.5" fill="#fff" stroke="#000" stroke-width="1.5"/></g>`;
}

const meaning = { better: "selected and true", missed: "missed", worse: "selected, not true" };
const chips = (e) => !e.phi.length ? "" : `<div class="chips">` + e.phi.map(([what, kind, names]) =>
  `<span class="${kind}" title="${escaped(what)}: ${meaning[kind]}">${escaped(names)}</span>`).join("") + `</div>`;

const whose = (e) => e.cell.participant && `, participant ${e.cell.participant}`;

function card(e) {
  const where = `${e.cell.scenario}, ${e.arm}, scene ${e.index}, training seed ${e.cell.seed}${whose(e)}`;
  const told = `<b>${e.failure || "success"}</b>${e.attribution ? `, attributed to the ${e.attribution}` : ""}`;
  const way = e.action ? `, action from ${e.action.map((place) => place.join(",")).join(" to ")}` : ", no action";
  return `<figure><div class="pair">${picture(e.picture, `scene: ${where}${way}`, arrow(e.action))}` +
    (e.mask ? picture(e.mask, `goal mask: ${where}`, arrow(e.action)) : "") +
    `</div><figcaption>${told}<br>${escaped(e.command)}${chips(e)}` +
    `<small>${escaped(where)}</small><code>lgabench replay RUN ${e.cell.cell}/${escaped(e.arm)}/${e.index} --out episode.gif</code>` +
    `</figcaption></figure>`;
}

// The first `most` of a list, and a button for more of it.
function growing(list, most, render) {
  const box = document.createElement("div");
  const draw = (count) => {
    box.innerHTML = render(list.slice(0, count));
    if (count >= list.length) return;
    const more = document.createElement("button");
    more.type = "button";
    more.textContent = `${count} of ${list.length} shown: more`;
    more.onclick = () => draw(count * 4);
    box.append(more);
  };
  draw(most);
  return box;
}

// The episodes of a row that ended in one way, or in any.
function fill(body, row, outcome) {
  const all = episodesOf(row).filter((e) => !outcome || (e.failure || "success") === outcome);
  const failed = all.filter((e) => e.failure), seen = all.filter((e) => e.picture);
  body.innerHTML = `<p>${all.length} episodes, ${failed.length} failed; ${seen.length} with a picture on this page. ` +
    "The arrow is the action, from where it takes hold to where it lets go.</p>";
  if (seen.length) body.append(growing(seen, 12, (some) => `<div class="scenes">${some.map(card).join("")}</div>`));
  const line = (e) => `<tr>${[e.cell.scenario, e.arm, e.cell.seed + whose(e), e.index, e.command, e.failure || "success", e.attribution]
    .map((text) => `<td>${escaped(text)}</td>`).join("")}</tr>`;
  body.append(growing([...failed, ...all.filter((e) => !e.failure)], 100, (some) =>
    `<div class="frame"><table><caption>Episodes, the failed ones first</caption><thead><tr>` +
    ["scenario", "arm", "training seed", "scene", "command", "outcome", "attributed to"]
      .map((head) => `<th scope="col">${head}</th>`).join("") +
    `</tr></thead><tbody>${some.map(line).join("")}</tbody></table></div>`));
}

function show(row, outcome = "") {
  $("panel-title").textContent = data.titles[row];
  const counts = new Map();
  for (const e of episodesOf(row)) counts.set(e.failure || "success", (counts.get(e.failure || "success") || 0) + 1);
  const choice = document.createElement("select"), body = document.createElement("div");
  choice.ariaLabel = "Which episodes";
  choice.innerHTML = `<option value="">all outcomes</option>` + [...counts].map(([word, n]) =>
    `<option${word === outcome ? " selected" : ""} value="${escaped(word)}">${escaped(word)} (${n})</option>`).join("");
  choice.onchange = () => {
    fill(body, row, choice.value);
    history.replaceState(null, "", `#row=${row}${choice.value ? `&outcome=${encodeURIComponent(choice.value)}` : ""}`);
  };
  $("panel-body").replaceChildren(choice, body);
  choice.onchange();
  tip.hidden = true;
  if (!$("panel").open) $("panel").showModal();
  $("panel").scrollTop = 0;
}

// The row before or after, with the arrow keys.
$("panel").onkeydown = (event) => {
  const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key], row = Number(/row=(\d+)/.exec(location.hash)?.[1]);
  if (step && event.target.tagName !== "SELECT" && data.titles[row + step]) show(row + step);
};
$("panel").onclose = () => history.replaceState(null, "", location.pathname + location.search);
const linked = /^#row=(\d+)(?:&outcome=(.*))?$/.exec(location.hash);
if (linked && data.titles[linked[1]]) show(Number(linked[1]), decodeURIComponent(linked[2] || ""));

for (const number of document.querySelectorAll("[data-row]")) {
  number.addEventListener("click", () => show(Number(number.dataset.row)));
  if (!(number instanceof HTMLButtonElement))
    number.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") event.preventDefault(), show(Number(number.dataset.row));
    });
}
$("close").onclick = () => $("panel").close();
