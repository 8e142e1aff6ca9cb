// Looks at every page of the built book with axe-core, in every theme, and at what a browser does
// with a page: node book/axe.mjs [PAGE …]
//
// It needs the built book, a Chromium, whose path may stand in CHROMIUM, and
// `npm install --prefix target/browse playwright-core axe-core`.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
import path from "node:path";

const root = path.resolve(import.meta.dirname, "..");
const book = path.join(root, "target/book");
const browse = createRequire(path.join(root, "target/browse/"));
const { chromium } = browse("playwright-core");
const themes = ["light", "navy", "coal", "rust", "ayu"];
const chapters = readdirSync(book).filter((name) => name.endsWith(".html") && !["print.html", "toc.html"].includes(name));
const pages = process.argv.length > 2 ? process.argv.slice(2) : [...chapters, "source/index.html", "source/src/method/one_bar.html"];
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run"],
});
const before = Date.now();
const faults = new Map();
const fault = (words, where) => faults.set(words, [...(faults.get(words) ?? []), where]);

// All rules are asked once on each page. A theme changes colours only: of all texts of the book
// that have the same colours, size and weight one is looked at.
const known = new Set();

// Runs in the page. What is beside each other leaves no third of a page empty, and what is wider
// than the page can be scrolled by keys; a table says so.
function layout() {
  const words = [];
  const height = (column) => {
    const boxes = [...column.querySelectorAll("p, pre, .equation, ul, ol, details")].filter((one) => one.checkVisibility()).map((one) => one.getBoundingClientRect());
    return Math.max(0, ...boxes.map((box) => box.bottom)) - Math.min(...boxes.map((box) => box.top));
  };
  for (const pair of document.querySelectorAll(".side")) {
    const [prose, code] = pair.children;
    if (prose.offsetLeft === code.offsetLeft) continue;
    const less = height(prose) - height(code);
    const empty = Math.abs(less) * (less < 0 ? prose : code).offsetWidth / (pair.offsetWidth * 900);
    if (empty > 1 / 3) words.push(`a pair leaves ${empty.toFixed(2)} of a page empty beside ${code.querySelector("pre")?.id}`);
  }
  for (const box of document.querySelectorAll("main :is(.table-wrapper, pre, pre > code)")) {
    if (box.scrollWidth <= box.clientWidth + 1) continue;
    if (box.tabIndex < 0) words.push("what scrolls is not reached by keys");
    const caption = document.getElementById(box.getAttribute("aria-labelledby"));
    if (box.matches(".table-wrapper") && !caption?.querySelector(".scroll-hint")) words.push("a table does not say that it scrolls");
  }
  return words;
}

async function look(page, name) {
  await page.goto(pathToFileURL(path.join(book, name)).href);
  for (const width of [500, 800, 1400]) {
    await page.setViewportSize({ width, height: 1000 });
    // The table of contents slides away, and the page hears of its new width.
    await page.waitForTimeout(350);
    const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    if (over > 0) fault(`${over} px wider than ${width} px`, name);
    for (const words of await page.evaluate(layout)) fault(words, `${name} (${width} px)`);
  }
  const number = page.locator("a.eq").first();
  if (await number.count()) {
    await number.focus();
    await page.locator(".shown-equation .katex").waitFor({ timeout: 5000 }).catch(() => fault("the number of an equation does not show it", name));
    await page.keyboard.press("Escape");
  }
  await page.evaluate(() => {
    document.querySelectorAll("details").forEach((one) => { one.open = true; });
    document.querySelectorAll(".katex").forEach((one) => { one.textContent = "x"; });
  });
  await page.addScriptTag({ path: browse.resolve("axe-core/axe.min.js") });
  for (const theme of ["", ...themes]) {
    const [found, looks] = await page.evaluate(async ([theme, known]) => {
      const looks = new Map();
      const options = { resultTypes: ["violations"], rules: { "color-contrast": { enabled: false } } };
      const where = { exclude: [".line"] };
      if (theme) {
        document.getElementById(`mdbook-theme-${theme}`).click();
        for (const one of document.querySelectorAll("body *")) {
          if (one.matches("svg *, pre, pre > code") || ![...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim())) continue;
          const colour = (one) => getComputedStyle(one).backgroundColor;
          let on = one;
          while (on && /, 0\)$|transparent/.test(colour(on))) on = on.parentElement;
          const { color, fontSize, fontWeight, opacity } = getComputedStyle(one);
          const key = [color, on && colour(on), fontSize, fontWeight, opacity].join();
          if (!known.includes(key) && (!looks.has(key) || looks.get(key).firstElementChild)) looks.set(key, one);
        }
        if (!looks.size) return [[], []];
        where.include = [...looks.values()];
        options.runOnly = ["color-contrast"];
        delete options.rules;
      }
      const result = await axe.run(where, options);
      const faults = result.violations.filter((one) => ["serious", "critical"].includes(one.impact)).flatMap((one) => one.nodes.map((node) => {
        const { fgColor, bgColor, contrastRatio } = node.any[0]?.data ?? {};
        return [`${one.id}: ${fgColor ? `${fgColor} on ${bgColor} is ${contrastRatio}` : node.html.slice(0, 200)}`, node.target.join(" ")];
      }));
      return [faults, [...looks.keys()]];
    }, [theme, [...known]]);
    looks.forEach((key) => known.add(key));
    for (const [words, target] of found) fault(words, `${name} (${theme || "any theme"}) ${target}`);
  }
}

async function worker(queue) {
  const context = await browser.newContext();
  const page = await context.newPage();
  page.on("pageerror", (error) => fault(String(error), page.url()));
  for (let name = queue.shift(); name; name = queue.shift()) await look(page, name);
}
const queue = [...pages];
await Promise.all([worker(queue), worker(queue)]);
await browser.close();
for (const [words, where] of faults) console.error(`${words}\n    ${where.length} times, first in ${where[0]}`);
assert.equal(faults.size, 0, `${faults.size} faults`);
console.log(`axe: ${pages.length} pages in ${themes.length} themes, nothing serious, ${Math.round((Date.now() - before) / 1000)} s`);
