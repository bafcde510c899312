"use strict";
// What all pages do.

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

$("close").onclick = () => $("panel").close();
