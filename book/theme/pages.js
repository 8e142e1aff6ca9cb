// What a page gains by JavaScript; all of it can be read without.
"use strict";
(() => {

// What is wider than the page scrolls, and says so. A table that fits needs no stop of the keyboard.
function mark() {
  for (const box of document.querySelectorAll(".content main :is(.table-wrapper, pre, pre > code, .equation)")) {
    const scrolls = box.scrollWidth > box.clientWidth + 1;
    if (scrolls) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
    if (!box.classList.contains("table-wrapper")) continue;
    box.classList.toggle("scrolls", scrolls);
    const caption = document.getElementById(box.getAttribute("aria-labelledby"));
    const hint = caption?.querySelector(".scroll-hint");
    if (!scrolls) hint?.remove();
    else if (caption && !hint) {
      const words = document.createElement("span");
      words.className = "scroll-hint";
      words.textContent = "The table is wider than the page: it scrolls, by the arrow keys too.";
      caption.append(words);
    }
  }
}
// The table of contents, the fonts and the window change the width.
new ResizeObserver(mark).observe(document.querySelector(".content main"));
document.addEventListener("toggle", mark, true);

// The number of an equation shows it. All equations stand in one file, which is loaded when the
// first is asked for.
let shown = null;
let loading = null;
function equations() {
  loading ??= new Promise((done) => {
    const script = document.createElement("script");
    script.src = `${path_to_root}theme/equations.js`;
    script.onload = done;
    document.head.append(script);
  });
  return loading;
}
function hide() {
  shown?.link.removeAttribute("aria-describedby");
  shown?.box.remove();
  shown = null;
}
async function show(link) {
  if (shown?.link === link) return;
  hide();
  shown = { link, box: document.createElement("div") };
  await equations();
  const equation = window.EQUATIONS[link.textContent.slice(1, -1)];
  if (shown?.link !== link || !equation) return;
  const box = shown.box;
  box.className = "shown-equation";
  box.id = "shown-equation";
  box.role = "tooltip";
  box.innerHTML = equation;
  document.body.append(box);
  link.setAttribute("aria-describedby", box.id);
  const at = link.getBoundingClientRect();
  const room = document.documentElement.clientWidth - box.offsetWidth - 8;
  box.style.left = `${scrollX + Math.max(8, Math.min(at.left, room))}px`;
  const below = at.bottom + box.offsetHeight + 8 < innerHeight;
  box.style.top = `${scrollY + (below ? at.bottom + 4 : at.top - box.offsetHeight - 4)}px`;
}
for (const link of document.querySelectorAll("a.eq")) {
  link.addEventListener("mouseenter", () => show(link));
  link.addEventListener("focus", () => show(link));
  link.addEventListener("mouseleave", (event) => { if (!shown?.box.contains(event.relatedTarget)) hide(); });
  link.addEventListener("blur", hide);
}
addEventListener("keydown", (event) => { if (event.key === "Escape") hide(); });
})();
