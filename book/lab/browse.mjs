// Opens the lab in a browser and does what a reader would: node book/lab/browse.mjs [SCREENSHOTS]
//
// It needs the built book, the program of `cargo build`, a Chromium, whose path may stand in
// CHROMIUM, and `npm install --prefix target/browse playwright-core axe-core`.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
import path from "node:path";

const root = path.resolve(import.meta.dirname, "../..");
const from = createRequire(path.join(root, "target/browse/"));
const { chromium } = from("playwright-core");
const axe = readFileSync(from.resolve("axe-core/axe.min.js"), "utf8");
const page0 = pathToFileURL(path.join(root, "target/book/lab.html")).href;
const shots = process.argv[2];
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run"],
});
const problems = [];
let checks = 0;
const check = (is, words) => { checks += 1; assert.ok(is, words); };

// Opens a page of this width; whatever it asks of a network, or writes to the console, is noted.
async function open(width, hash = "", { theme = "light", script = () => {}, touch = false } = {}) {
  const context = await browser.newContext({ viewport: { width, height: 1000 }, acceptDownloads: true, hasTouch: touch });
  await context.addInitScript((theme) => { try { localStorage.setItem("mdbook-theme", theme); } catch {} }, theme);
  await context.addInitScript(script);
  const page = await context.newPage();
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) problems.push(`asks for ${request.url()}`); });
  page.on("console", (message) => { if (message.type() === "error") problems.push(message.text()); });
  page.on("pageerror", (error) => problems.push(String(error)));
  const before = Date.now();
  await page.goto(page0 + hash);
  await page.waitForSelector("#lab[data-ready]");
  page.opened = Date.now() - before;
  return page;
}
const part = (page, name) => page.locator(`#lab [data-lab="${name}"]`);
const say = (page, name) => part(page, name).textContent();
// Does something and waits until the run that follows is over.
async function after(page, doing) {
  const done = await page.locator("#lab").getAttribute("data-done");
  await doing();
  await page.waitForFunction((done) => document.getElementById("lab").dataset.done !== done, done, { timeout: 60000 });
}
const put = (page, name, value) => part(page, name).evaluate((input, value) => { input.value = value; input.dispatchEvent(new Event("input", { bubbles: true })); }, value);
const slide = (page, name, value) => after(page, () => put(page, name, value));
const choose = (page, name, value) => after(page, () => part(page, name).selectOption(value));
const preset = async (page, name) => { await after(page, () => page.locator(`button[value="${name}"]`).click()); return say(page, "figures"); };
const number = (words, after) => Number(words.split(after)[1].trim().split(/[ ;]/)[0]);
const velocity = (figures) => number(figures, "error of velocity end");
const place = (least, most, value) => (1000 * Math.log(value / least)) / Math.log(most / least);
const drawn = (page, name) => part(page, name).evaluate((canvas) => {
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  let inked = 0;
  for (let i = 3; i < pixels.length; i += 4) inked += pixels[i] > 0;
  return inked;
});
const shown = (page, what) => page.evaluate(`(({ run, frame }) => ${what})(LAB.shown())`);

// The first picture, and what the page says of it. Runs are in a worker, from a disk, too.
let page = await open(1400);
check(/lme-mpm run data\/scenes\/dyka\.toml --set time\.cfl=0\.5$/.test(await say(page, "command")), "the command of the start");
check(await page.locator(".lab-static").isHidden(), "the static figure is away");
check(await page.evaluate("LAB.program.isWorker()"), "a worker computes");
const time = await part(page, "play").boundingBox();
check(time.y > 0 && time.y + time.height <= 1000, `the time is in the first view: ${time.y}`);
for (const name of ["v", "s", "map", "probe", "energy", "N", "slope", "force"]) check((await drawn(page, name)) > 800, `${name} is drawn`);

// What the summary of the native program says of the command that the page shows, number by number.
async function isNative(page, name) {
  const out = path.join(root, "target/browse/out", name);
  const [, ...words] = (await say(page, "command")).match(/'[^']*'|[^ ]+/g).map((word) => word.replace(/'/g, ""));
  try { execFileSync(path.join(root, "target/debug/lme-mpm"), [...words, "--quiet", "--out", out], { cwd: root, stdio: "pipe" }); } catch { return false; }
  const lines = readFileSync(path.join(out, "summary.csv"), "utf8").trim().split("\n").slice(1).map((line) => line.split(","));
  const own = await shown(page, "run.summary");
  const same = lines.filter(([quantity, value]) => own[quantity] === Number(value)).length;
  const missing = lines.filter(([quantity, value]) => quantity in own && own[quantity] !== Number(value));
  check(same > 10 && missing.length === 0, `${name}: the native program has other numbers: ${missing}`);
  return true;
}

// The presets show what they claim.
const dispersed = velocity(await preset(page, "dispersion"));
check(dispersed > 15 && dispersed < 18, `dispersion: ${dispersed} %`);
check(await isNative(page, "dispersion"), "the native program runs");
const filtered = velocity(await preset(page, "lumping"));
check(filtered > dispersed, `lumping filters: ${filtered} %`);
await isNative(page, "lumping");
const gained = velocity(await preset(page, "smooth"));
check(gained < dispersed / 3, `a smooth basis: ${gained} %`);
await isNative(page, "smooth");
await slide(page, "gamma", 330);
check(velocity(await say(page, "figures")) > 1.66 * gained, `the gain is a spike: ${gained} and ${await say(page, "figures")}`);
const grown = number(await preset(page, "limit"), "energy +");
check(grown > 1000, `one percent above √3: the energy grows ${grown} times`);
check(/the limit is 1\.732, and this is beyond it/.test(await say(page, "limit")), "the limit is √3");
check(await part(page, "beyond").isVisible(), "what lies beyond is marked");
await isNative(page, "limit");
await after(page, () => part(page, "blowup").uncheck());
check(/the time step is too large: c Δt \/ h is 1\.7/.test(await say(page, "error")), "the program refuses");
check(/the limit is 1\.732/.test(await say(page, "limit")), "the limit of what is refused is known");
const noisy = await preset(page, "crossing");
check(number(noisy, "of σ") > 30, `crossing: ${noisy}`);
await isNative(page, "crossing");
await choose(page, "basis", "lme");
check(number(await say(page, "figures"), "of σ") < 5, `crossing, local max-ent: ${await say(page, "figures")}`);
await preset(page, "light");
check(/the limit is 0\.[3-9]|the limit is [1-9]/.test(await say(page, "limit")), `a light node: ${await say(page, "limit")}`);
await isNative(page, "light");
const sharp = number(await preset(page, "otm"), "of u");
check(sharp < 0.002, `OTM: ${sharp} %`);
await isNative(page, "otm");
await slide(page, "cfl", place(0.05, 6, 0.9));
check(number(await say(page, "figures"), "of u") > 100 * sharp, "OTM below Courant one");
const said = async () => (await say(page, "warning")) + (await say(page, "error"));
await preset(page, "rotation");
check(/angular momentum has changed|has turned by/.test(await said()), "rotation is warned of");
await choose(page, "law", "neo-hookean");
check(!/has turned by/.test(await said()), "the neo-Hookean law turns with the material");
await isNative(page, "rotation");
check((await drawn(page, "plane")) > 800, "the discs are drawn");

// The spinning bar: the angle between its axis and its left edge, off a right one (rad).
const sheared = () => shown(page, `(() => {
  const x = run.at("x", frame), y = run.at("y", frame), X = x.map((x, p) => x - run.at("u", frame)[p]), Y = y.map((y, p) => y - run.at("w", frame)[p]);
  const near = (a, b) => X.reduce((best, _, p) => (Math.hypot(X[p] - a, Y[p] - b) < Math.hypot(X[best] - a, Y[best] - b) ? p : best), 0);
  const [left, right, below, above] = [near(0.3, 0.125), near(0.7, 0.125), near(0.5, 0), near(0.5, 0.25)];
  const [a, b] = [[right, left], [above, below]].map(([p, q]) => Math.atan2(y[p] - y[q], x[p] - x[q]));
  return Math.abs(((b - a + 4 * Math.PI) % (2 * Math.PI)) - Math.PI / 2);
})()`);
await preset(page, "spin");
await isNative(page, "spin");
const [bent, turned] = [await sheared(), await shown(page, "run.t[frame]")];
check(turned > 10 && /has turned by/.test(await said()), "the rate law turns once, and is warned of");
await choose(page, "law", "neo-hookean");
const straight = await sheared();
check(bent > 0.35 && straight < bent / 2, `a spinning bar: sheared by ${bent} with the rate law, ${straight} with the other`);
for (const colour of ["stress", "speed"]) { await part(page, "colour").selectOption(colour); check((await drawn(page, "plane")) > 800, `coloured by ${colour}`); }

// A long run says how far it is, moves while it is computed, gives way to another, and can be stopped.
await preset(page, "rotation");
await choose(page, "law", "neo-hookean");
await put(page, "cells", 100);
await part(page, "running").waitFor();
await page.waitForFunction(() => LAB.shown().run.t.length > 3 && !LAB.shown().run.done);
const soFar = await shown(page, "frame");
await page.waitForFunction((soFar) => LAB.shown().frame > soFar, soFar);
check(/running: \d+ % of/.test(await say(page, "progress")), `a long run says how far it is: ${await say(page, "progress")}`);
await part(page, "halt").click();
check(/stopped here after \d+ steps/.test(await say(page, "error")), "a run is stopped");
check(await part(page, "running").isHidden(), "and does not run any more");
await put(page, "cells", 110);
await page.waitForTimeout(100);
await preset(page, "dispersion");
check(velocity(await say(page, "figures")) === dispersed, "what is stale is dropped");

// The links of the presets lead somewhere.
for (const button of await page.locator('[data-lab="presets"] button').all()) {
  await after(page, () => button.click());
  const link = await page.locator('[data-lab="words"] a').getAttribute("href"), [file, place] = link.split("#");
  check(readFileSync(path.join(root, "target/book", file), "utf8").includes(`id="${place}"`), `${link} leads somewhere`);
}

// What cannot be is refused in the program's own words, and taken back.
await preset(page, "otm");
await choose(page, "basis", "bspline");
check(/basis\.kind/.test(await say(page, "error")), "OTM has no B-splines");
await choose(page, "basis", "linear");
check((await say(page, "error")) === "", "the error goes away");

// Time: play, step, scrub by keys.
await preset(page, "dispersion");
await part(page, "frame").focus();
await page.keyboard.press("Home");
check(/t = 0/.test(await say(page, "now")), "the start");
await page.keyboard.press("ArrowRight");
await part(page, "on").click();
check((await part(page, "frame").inputValue()) === "2", "two frames on");
await part(page, "play").click();
await page.waitForFunction(() => LAB.shown().frame > 4);
await part(page, "play").click();
const click = async (name, across, down) => {
  await part(page, name).scrollIntoViewIfNeeded();
  const box = await part(page, name).boundingBox();
  await page.mouse.click(box.x + across * box.width, box.y + down * box.height);
};
await click("probe", 0.5, 0.3);
const middle = Number(await part(page, "frame").inputValue());
check(middle > 60 && middle < 100, `a click in a history: ${middle}`);
await click("N", 0.7, 0.4);
check(/their sum is 1\./.test(await say(page, "shape-words")), "a partition of unity");

// The point in the picture over position and time: by mouse, by keys, by touch.
await click("map", 0.2, 0.5);
check(/velocity of the point/.test(await part(page, "probe-name").evaluate((select) => select.selectedOptions[0].textContent)), "the probe follows the point");
check(/point=0\.\d+/.test(page.url()), "the address has the point");
const pointed = async (page) => Number(await part(page, "map").getAttribute("aria-valuenow"));
const before = await pointed(page);
await part(page, "map").focus();
for (const key of ["ArrowRight", "ArrowRight", "ArrowUp"]) await page.keyboard.press(key);
check((await pointed(page)) === before + 2, "keys move the point");
check(/material point at 0\.\d+ m/.test(await part(page, "map").getAttribute("aria-valuetext")), "and say where it is");
const box = await part(page, "map").boundingBox();
await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
await page.mouse.down();
await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.3 * box.height, { steps: 4 });
await page.mouse.up();
const dragged = await pointed(page);
check(dragged > before + 5, `a drag moves the point: ${before} to ${dragged}`);
// The exact history of the point is that of the exact picture: v changes by the throw over two.
const exact = await page.evaluate(() => { const { v } = LAB.exact.history(LAB.bar.material(LAB.shown().run)); return [...new Set(v)].sort((a, b) => a - b); });
check(exact.includes(2.5) && exact.includes(0) && exact.includes(-2.5), `the exact history of the point: ${exact}`);
const labels = await page.evaluate(() => { const canvas = document.createElement("canvas"); return LAB.regions(canvas.getContext("2d"), LAB.shown().run, { left: 0, top: 0, half: 330, bottom: 350 }).map(({ v, s }) => `${v} ${Math.round(s / 1e6)}`); });
for (const region of ["0 0", "2.5 99", "0 198", "-2.5 99", "-5 0", "2.5 -99", "0 -198"]) check(labels.includes(region), `the region ${region} has its label: ${labels}`);

// The force on a node jumps with the linear basis, and with no smooth one.
const force = async (basis) => { await choose(page, "basis", basis); return say(page, "force-words"); };
check(/it jumps from [-−]1 N to 1 N/.test(await say(page, "force-words")), await say(page, "force-words"));
for (const basis of ["ugimp", "bspline", "bspline3", "lme"]) { const words = await force(basis); check(/No jump/.test(words), `${basis}: ${words}`); }

// Step through: nine steps, each with lines of the listing and with values.
await preset(page, "dispersion");
await page.locator("#lab .lab-steps summary").click();
const lit = () => page.locator("#lab .lab-lit").allTextContents();
const listing = readFileSync(path.join(root, "src/method/one_bar.rs"), "utf8");
await part(page, "step-back").click();
for (let n = 1; n <= 9; n++) {
  await part(page, "step-on").click();
  const lines = await lit();
  check((await say(page, "step-name")).startsWith(`Step ${n}:`) && lines.length > 1 && lines[0].includes(`// Step ${n}`), `step ${n} is lit: ${lines[0]}`);
  check(lines.every((line) => listing.includes(line.trim())), `step ${n} is of the file`);
}
const inView = await page.evaluate(() => { const [line, pre] = [".lab-lit", ".lab-listing pre"].map((name) => document.querySelector(`#lab ${name}`).getBoundingClientRect()); return line.top >= pre.top && line.bottom <= pre.bottom; });
check(inView, "the lines that are lit are in view");
await part(page, "step-on").click();
check(/k = 2/.test(await say(page, "step-k-out")) && (await say(page, "step-name")).startsWith("Step 1"), "the next time step begins");
await put(page, "step-k", 5);
check(/k = 5/.test(await say(page, "step-k-out")), "a time step is chosen");
check((await page.locator("#lab .lab-steps .lab-new").count()) > 4 && (await drawn(page, "step-picture")) > 800, "what a step changes stands out");

// The address, the command, the file.
const other = await open(1400, "#basis=lme&gamma=0.8&cells=20");
check(/basis\.kind=lme --set basis\.gamma=0\.8 --set grid\.cells=20/.test(await say(other, "command")), "the address is read");
await slide(other, "gamma", 700);
check(/gamma=3\.49/.test(other.url()), `the address is written: ${other.url()}`);
const [file] = await Promise.all([other.waitForEvent("download"), part(other, "download").click()]);
check(/^step,t,kinetic_energy/.test(readFileSync(await file.path(), "utf8")), "the file is a history");

// Without a worker the page computes by itself, in pieces.
const alone = await open(1400, "#preset=smooth", { script: () => { delete window.Worker; } });
check(!(await alone.evaluate("LAB.program.isWorker()")) && velocity(await say(alone, "figures")) === gained, "without a worker");
// Where touch is, it moves the point.
const touched = await open(500, "", { touch: true });
const at = await part(touched, "map").evaluate((canvas) => { canvas.scrollIntoView({ block: "center" }); const { x, y, width, height } = canvas.getBoundingClientRect(); return { x: x + 0.3 * width, y: y + 0.5 * height }; });
await touched.touchscreen.tap(at.x, at.y);
check((await pointed(touched)) < 60, "a touch moves the point");

// Every control has a name; nothing is wider than the page; nothing serious for a screen reader.
const unnamed = await page.locator("#lab :is(input, select, button)").evaluateAll((all) =>
  all.filter((one) => !one.labels?.length && !one.getAttribute("aria-label") && !one.textContent.trim()).map((one) => one.outerHTML));
check(unnamed.length === 0, `without a name: ${unnamed}`);
for (const theme of ["light", "navy"]) for (const width of [1400, 500]) {
  const one = await open(width, "#preset=smooth", { theme });
  await one.locator("#lab .lab-steps summary").click();
  const over = await one.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  check(over <= 0, `${width} px: ${over} px too wide`);
  await one.evaluate(axe);
  const { violations } = await one.evaluate(() => axe.run("#lab", { preload: false }));
  const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  check(serious.length === 0, `${theme}, ${width} px: ${JSON.stringify(serious.map(({ id, nodes }) => [id, nodes.map(({ html, failureSummary }) => [html.slice(0, 120), failureSummary])]), null, 1)}`);
}
if (shots) for (const theme of ["light", "navy"]) for (const width of [1400, 500]) {
  for (const name of ["dispersion", "lumping", "smooth", "limit", "crossing", "light", "otm", "rotation", "spin"]) {
    const one = await open(width, `#preset=${name}`, { theme });
    await one.locator("#lab").screenshot({ path: path.join(shots, `${name}-${width}-${theme}.png`) });
    await one.context().close();
  }
}

// Without JavaScript and in print the figure stands there.
const plain = await browser.newContext({ javaScriptEnabled: false });
const still = await plain.newPage();
await still.goto(page0);
check(await still.locator("#lab .lab-static img").isVisible(), "a figure without JavaScript");
check(/Without it, and in print/.test(await still.locator("#lab .lab-static").textContent()), "and a sentence");
await page.emulateMedia({ media: "print" });
check(await page.locator("#lab .lab-static").isVisible() && await page.locator("#lab .lab-live").isHidden(), "a figure in print");
await page.emulateMedia({ media: "screen" });

// Times, to be read, not to be held: the least of several moves of a slider, from the hand to the
// first picture of the new run, and to its last.
await page.locator("#lab .lab-steps summary").click();
const times = [];
for (const name of ["dispersion", "lumping", "smooth", "limit", "crossing", "light", "otm"]) {
  await preset(page, name);
  const [first, last] = await page.evaluate(async () => {
    const lab = document.getElementById("lab"), input = lab.querySelector('[data-lab="cfl"]'), start = Number(input.value);
    const least = [Infinity, Infinity];
    for (let i = 1; i <= 10; i++) {
      const before = performance.now(), over = new Promise((done) => new MutationObserver((_, all) => { all.disconnect(); done(); }).observe(lab, { attributeFilter: ["data-done"] }));
      input.value = start - (i % 2);
      input.dispatchEvent(new Event("input", { bubbles: true }));
      await over;
      const { began, drawn } = LAB.shown().run;
      least[0] = Math.min(least[0], began + drawn - before);
      least[1] = Math.min(least[1], performance.now() - before);
    }
    return least;
  });
  times.push(`${name} ${first.toFixed(0)} ms${last - first > 2 ? ` (the whole run after ${last.toFixed(0)})` : ""}`);
}
console.log(`the first picture after ${page.opened} ms; a move of a slider: ${times.join(", ")}`);
await browser.close();
assert.deepEqual(problems, []);
console.log(`lab: ${checks} passed, 0 failed`);
