"use strict";
// What all pages do.

const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const words = (text) => text.replaceAll("_", " ");

// Dark or light: the system's wish until the button is pressed, then what was chosen.
const root = document.documentElement;
try { root.dataset.theme = localStorage.getItem("lgabench-theme") || ""; } catch { /* a browser that keeps nothing */ }
const system = matchMedia("(prefers-color-scheme: dark)");
const isDark = () => root.dataset.theme ? root.dataset.theme === "dark" : system.matches;
const nameTheme = () => { $("theme").textContent = isDark() ? "Light colours" : "Dark colours"; };
$("theme").hidden = false;
nameTheme();
system.onchange = nameTheme;
$("theme").onclick = () => {
  root.dataset.theme = isDark() ? "light" : "dark";
  nameTheme();
  try { localStorage.setItem("lgabench-theme", root.dataset.theme); } catch { /* likewise */ }
};

$("contents").hidden = false;
$("contents").querySelector("nav").innerHTML = [...document.querySelectorAll("main section")]
  .map((section) => `<a href="#${section.id}">${section.querySelector("h2").textContent}</a>`).join("");

// Numbers sort as numbers ("< 0.001" among them), what has none goes last; each group by itself.
const numberOf = (text) => parseFloat(text.replace(/^< /, ""));
for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.querySelectorAll("thead th")];
  heads.forEach((head, column) => {
    head.innerHTML = `<button type="button">${head.innerHTML}</button>`;
    head.firstChild.onclick = () => {
      // Numbers begin with the largest, words with the first of the alphabet.
      const begins = [...table.tBodies].flatMap((body) => [...body.rows]).find((row) => row.className !== "group");
      const before = head.getAttribute("aria-sort");
      const descending = before ? before === "ascending" : head.textContent !== "rank" && !isNaN(numberOf(begins.cells[column].textContent.trim()));
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", descending ? "descending" : "ascending");
      const key = (row) => row.cells[column].textContent.trim();
      for (const body of table.tBodies) {
        const rows = [...body.rows].filter((row) => row.className !== "group");
        rows.sort((a, b) => {
          const [x, y] = [key(a), key(b)], [m, n] = [numberOf(x), numberOf(y)];
          if (isNaN(m) !== isNaN(n)) return isNaN(m) ? 1 : -1;
          return (isNaN(m) ? x.localeCompare(y) : m - n) * (descending ? -1 : 1);
        });
        body.append(...rows);
      }
    };
  });
}

// A table's heads stay in view while the page scrolls. One that is wider than its place scrolls sideways in it. On a narrow
// screen and on paper it becomes a list of its rows, each number with its column's head before it. Before it scrolls, its
// intervals go below their numbers.
const narrow = 900;  // px
function fit(within = document) {
  const frames = [...within.querySelectorAll(".frame")];
  frames.forEach((frame) => frame.classList.remove("list", "stacked", "fits"));
  const lists = innerWidth < narrow || document.body.classList.contains("printed");
  const tooWide = () => frames.filter((frame) => frame.scrollWidth > frame.clientWidth + 1);
  if (!lists) tooWide().forEach((frame) => frame.classList.add("stacked"));
  const wide = tooWide();
  frames.forEach((frame) => {
    const list = lists && wide.includes(frame), scrolls = !lists && wide.includes(frame);
    const heads = [...frame.querySelectorAll("thead th")].map((head) => head.textContent);
    for (const row of list ? frame.querySelectorAll("tbody tr:not(.group)") : [])
      [...row.cells].forEach((cell, i) => {
        if (i && !cell.querySelector(".name")) cell.dataset.head = heads[i];
        cell.classList.toggle("none", cell.textContent.trim() === "–");
      });
    frame.classList.toggle("list", list);
    frame.classList.toggle("fits", !scrolls);
    scrolls ? frame.setAttribute("tabindex", 0) : frame.removeAttribute("tabindex");
    const first = frame.querySelector("tbody tr:not(.group)");
    const name = !list && scrolls && first ? first.querySelectorAll("th").length - 1 : -1;  // the column of the rows' names
    for (const row of frame.querySelectorAll("tr:not(.group)"))
      [...row.cells].forEach((cell, i) => cell.classList.toggle("pinned", i === name));
    // A display of their own costs rows and cells their roles.
    for (const [what, role] of [["table", "table"], ["tbody", "rowgroup"], ["tr", "row"], ["td", "cell"], ["tbody th", "rowheader"]])
      frame.querySelectorAll(what).forEach((e) => list ? e.setAttribute("role", role) : e.removeAttribute("role"));
  });
}
let width = 0;
new ResizeObserver(() => {
  if (document.body.clientWidth !== width) width = document.body.clientWidth, fit();
}).observe(document.body);
for (const folded of document.querySelectorAll("main details")) folded.addEventListener("toggle", () => fit());

// On paper all is open, and as wide as a page of A4.
let closed = [];
addEventListener("beforeprint", () => {
  closed = [...document.querySelectorAll("main details:not([open])")];
  closed.forEach((folded) => { folded.open = true; });
  document.body.classList.add("printed");
  fit();
});
addEventListener("afterprint", () => {
  closed.forEach((folded) => { folded.open = false; });
  document.body.classList.remove("printed");
  fit();
});

// A name in a legend hides what belongs to it in its chart, and shows it again; the paper's curves have an entry for all.
for (const chart of document.querySelectorAll("svg.chart")) {
  const entries = [...chart.querySelectorAll(".entry")];
  const key = (element) => "published" in element.dataset ? "" : element.dataset.series;
  const draw = () => {
    const off = new Set(entries.filter((entry) => entry.getAttribute("aria-pressed") === "false").map(key));
    for (const series of chart.querySelectorAll(":scope > .series"))
      off.has(series.dataset.series) || off.has(key(series)) ? series.setAttribute("display", "none") : series.removeAttribute("display");
  };
  for (const entry of entries) {
    entry.setAttribute("role", "button");
    entry.setAttribute("aria-pressed", "true");
    entry.onclick = () => {
      entry.setAttribute("aria-pressed", entry.getAttribute("aria-pressed") === "false");
      draw();
    };
    entry.onkeydown = (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      entry.onclick();
    };
  }
}

// Of all buttons of a table, or points and names of a chart, one is a stop of the tab key; the arrow keys lead to the others.
const middle = (element) => {
  const box = element.getBoundingClientRect();
  return [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
};
const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
for (const box of document.querySelectorAll("main table, svg.chart")) {
  const items = [...box.querySelectorAll("button, .point, .entry")];
  items.forEach((item, i) => item.setAttribute("tabindex", i ? -1 : 0));
  const stop = (item) => {
    items.forEach((other) => other.setAttribute("tabindex", other === item ? 0 : -1));
    item.focus();
  };
  box.addEventListener("click", (event) => {
    const item = event.target.closest("button, .point, .entry");
    if (item) stop(item);
  });
  box.addEventListener("keydown", (event) => {
    const way = ways[event.key], end = { Home: items[0], End: items.at(-1) }[event.key];
    if (!way && !end) return;
    event.preventDefault();
    if (end) return stop(end);
    const [x, y] = middle(document.activeElement);
    let next = null, least = Infinity;  // the nearest on that side, more along the way than beside it
    for (const item of items.filter((one) => one.getClientRects().length)) {
      const [m, n] = middle(item), along = (m - x) * way[0] + (n - y) * way[1];
      const beside = Math.abs((m - x) * way[1]) + Math.abs((n - y) * way[0]);
      if (item !== document.activeElement && along > .5 && along + 4 * beside < least) next = item, least = along + 4 * beside;
    }
    if (next) stop(next);
  });
}

// Figures and tables to take away; figures/ and tables/ beside the page have them as PDF and LaTeX too.
const quoted = (text) => /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
function csvOf(frame) {
  const plain = (text) => /^[=+@-]/.test(text) && isNaN(text) ? "'" + text : text;  // a number is no formula
  const text = (cell) => quoted(plain(cell.textContent.trim()));
  let group = "";
  const lines = [["group", ...[...frame.querySelectorAll("thead th")].map(text)]];
  for (const row of frame.querySelectorAll("tbody tr"))
    if (row.className === "group") group = text(row.cells[0]);
    else lines.push([group, ...[...row.cells].map(text)]);
  return lines.map((line) => line.join(",") + "\n").join("");
}
const takeable = [...document.querySelectorAll("figure:not(.narrow) > svg.chart, .frame")].map((element) => ({
  name: element.getAttribute("aria-label"),
  ...(element.tagName === "svg" ? { ending: "svg", text: () => new XMLSerializer().serializeToString(element) }
    : { ending: "csv", text: () => csvOf(element) }),
}));
$("take").hidden = takeable.length === 0;
$("take").innerHTML = "<option value=''>Download …</option>" + ["svg", "csv"].map((ending) =>
  `<optgroup label="${ending.toUpperCase()}">` + takeable.map((one, i) => one.ending !== ending ? "" :
    `<option value="${i}">${escaped(one.name)}</option>`).join("") + "</optgroup>").join("");
$("take").onchange = () => {
  const one = takeable[$("take").value], link = document.createElement("a");
  $("take").value = "";
  if (!one) return;
  link.href = URL.createObjectURL(new Blob([one.text()]));
  link.download = `${one.name.replace(/[^\w-]+/g, "_").slice(0, 80)}.${one.ending}`;
  link.click();
};

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

// The first `most` of a list, and a button for more of it.
function growing(list, most, render) {
  const box = document.createElement("div");
  const draw = (count) => {
    box.innerHTML = render(list.slice(0, count));
    if (count >= list.length) return;
    const more = document.createElement("button");
    more.type = "button";
    more.textContent = `Show more (${count} of ${list.length})`;
    more.onclick = () => draw(count * 4);
    box.append(more);
  };
  draw(most);
  return box;
}

$("close").onclick = () => $("panel").close();
