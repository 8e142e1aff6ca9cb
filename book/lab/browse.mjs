// Opens the lab in a browser and does what a reader would: node book/lab/browse.mjs [SCREENSHOTS]
//
// It needs the built book, a Chromium, whose path may stand in CHROMIUM, and
// `npm install --prefix target/browse playwright-core`.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
import path from "node:path";

const root = path.resolve(import.meta.dirname, "../..");
const { chromium } = createRequire(path.join(root, "target/browse/"))("playwright-core");
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
async function open(width, hash = "", theme = "light") {
  const context = await browser.newContext({ viewport: { width, height: 1000 }, acceptDownloads: true });
  await context.addInitScript((theme) => { try { localStorage.setItem("mdbook-theme", theme); } catch {} }, theme);
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
const say = (page, name) => page.locator(`[data-lab="${name}"]`).textContent();
const slide = async (page, name, value) => {
  await page.locator(`[data-lab="${name}"]`).evaluate((input, value) => { input.value = value; input.dispatchEvent(new Event("input", { bubbles: true })); }, value);
  await page.waitForTimeout(120);
};
const choose = async (page, name, value) => { await page.locator(`[data-lab="${name}"]`).selectOption(value); await page.waitForTimeout(500); };
const preset = async (page, name) => { await page.locator(`button[value="${name}"]`).click(); await page.waitForTimeout(700); return say(page, "figures"); };
const number = (words, after) => Number(words.split(after)[1].trim().split(/[ ;]/)[0]);
const velocity = (figures) => number(figures, "error of velocity end");

// The first picture, and what the page says of it.
let page = await open(1400);
check(/lme-mpm run data\/scenes\/dyka\.toml --set time\.cfl=0\.5$/.test(await say(page, "command")), "the command of the start");
check(await page.locator(".lab-static").isHidden(), "the static figure is away");
const drawn = (name) => page.locator(`[data-lab="${name}"]`).evaluate((canvas) => {
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  let inked = 0;
  for (let i = 3; i < pixels.length; i += 4) inked += pixels[i] > 0;
  return inked;
});
for (const name of ["v", "s", "map", "probe", "energy", "N", "slope"]) check((await drawn(name)) > 800, `${name} is drawn`);

// The presets show what they claim.
const dispersed = velocity(await preset(page, "dispersion"));
check(dispersed > 15 && dispersed < 18, `dispersion: ${dispersed} %`);
const filtered = velocity(await preset(page, "lumping"));
check(filtered > dispersed, `lumping filters: ${filtered} %`);
const gained = velocity(await preset(page, "smooth"));
check(gained < dispersed / 3, `a smooth basis: ${gained} %`);
await slide(page, "gamma", 330);
await page.waitForTimeout(400);
check(velocity(await say(page, "figures")) > 1.9 * gained, "the gain is a spike");
const grown = number(await preset(page, "limit"), "energy +");
check(grown > 1000, `one percent above √3: the energy grows ${grown} times`);
check(/the limit is 1\.732/.test(await say(page, "limit")), "the limit is √3");
await page.locator('[data-lab="blowup"]').uncheck();
await page.waitForTimeout(300);
check(/the time step is too large: c Δt \/ h is 1\.7/.test(await say(page, "error")), "the program refuses");
const noisy = await preset(page, "crossing");
check(number(noisy, "of σ") > 30, `crossing: ${noisy}`);
await choose(page, "basis", "lme");
check(number(await say(page, "figures"), "of σ") < 5, `crossing, local max-ent: ${await say(page, "figures")}`);
await preset(page, "light");
check(/the limit is 0\.[3-9]|the limit is [1-9]/.test(await say(page, "limit")), `a light node: ${await say(page, "limit")}`);
const sharp = number(await preset(page, "otm"), "of u");
check(sharp < 0.002, `OTM: ${sharp} %`);
await slide(page, "cfl", (1000 * Math.log(0.9 / 0.05)) / Math.log(6 / 0.05));
check(number(await say(page, "figures"), "of u") > 100 * sharp, "OTM below Courant one");
await preset(page, "rotation");
await page.waitForTimeout(2500);
check(/angular momentum has changed|has turned by/.test((await say(page, "figures")) + (await say(page, "error"))), "rotation is warned of");
await choose(page, "law", "neo-hookean");
await page.waitForTimeout(2500);
check(!/has turned by/.test((await say(page, "figures")) + (await say(page, "error"))), "the neo-Hookean law turns with the material");
check((await drawn("plane")) > 800, "the discs are drawn");
await choose(page, "mass", "consistent");
await slide(page, "cells", 100);
await page.waitForTimeout(900);
check(/hold up the page/.test(await say(page, "error")), "a long run is left to the command line");
const links = await page.locator('[data-lab="presets"] button').count();
for (let n = 0; n < links; n++) {
  await page.locator('[data-lab="presets"] button').nth(n).click();
  await page.waitForTimeout(150);
  const link = await page.locator('[data-lab="words"] a').getAttribute("href");
  const [file, place] = link.split("#");
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
await page.locator('[data-lab="frame"]').focus();
await page.keyboard.press("Home");
check(/t = 0/.test(await say(page, "now")), "the start");
await page.keyboard.press("ArrowRight");
await page.locator('[data-lab="on"]').click();
check((await page.locator('[data-lab="frame"]').inputValue()) === "2", "two frames on");
await page.locator('[data-lab="play"]').click();
await page.waitForTimeout(500);
check(Number(await page.locator('[data-lab="frame"]').inputValue()) > 4, "it plays");
await page.locator('[data-lab="play"]').click();
await page.locator('[data-lab="probe"]').scrollIntoViewIfNeeded();
const box = await page.locator('[data-lab="probe"]').boundingBox();
await page.mouse.click(box.x + box.width / 2, box.y + 60);
const middle = Number(await page.locator('[data-lab="frame"]').inputValue());
check(middle > 60 && middle < 100, `a click in a history: ${middle}`);
await page.locator('[data-lab="N"]').scrollIntoViewIfNeeded();
const functions = await page.locator('[data-lab="N"]').boundingBox();
await page.mouse.click(functions.x + 0.7 * functions.width, functions.y + 60);
check(/their sum is 1\./.test(await say(page, "shape-words")), "a partition of unity");

// The address, the command, the file.
const other = await open(1400, "#basis=lme&gamma=0.8&cells=20");
check(/basis\.kind=lme --set basis\.gamma=0\.8 --set grid\.cells=20/.test(await say(other, "command")), "the address is read");
await slide(other, "gamma", 700);
check(/gamma=3\.49/.test(other.url()), `the address is written: ${other.url()}`);
const [file] = await Promise.all([other.waitForEvent("download"), other.locator('[data-lab="download"]').click()]);
check(/^step,t,kinetic_energy/.test(readFileSync(await file.path(), "utf8")), "the file is a history");

// Every control has a name.
const unnamed = await page.locator("#lab :is(input, select, button)").evaluateAll((all) =>
  all.filter((one) => !one.labels?.length && !one.getAttribute("aria-label") && !one.textContent.trim()).map((one) => one.outerHTML));
check(unnamed.length === 0, `without a name: ${unnamed}`);

// Narrow, dark: nothing is wider than the page.
for (const width of [1400, 500]) for (const theme of ["light", "navy"]) {
  const one = await open(width, "#preset=smooth", theme);
  const over = await one.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  check(over <= 0, `${width} px: ${over} px too wide`);
  if (shots) await one.screenshot({ path: path.join(shots, `lab-${width}-${theme}.png`), fullPage: true });
}
if (shots) for (const name of ["dispersion", "lumping", "smooth", "limit", "crossing", "light", "otm", "rotation"]) {
  const one = await open(1400, `#preset=${name}`);
  await one.locator("#lab").screenshot({ path: path.join(shots, `preset-${name}.png`) });
}

// Without JavaScript and in print the figure stands there.
const plain = await browser.newContext({ javaScriptEnabled: false });
const still = await plain.newPage();
await still.goto(page0);
check(await still.locator("#lab .lab-static img").isVisible(), "a figure without JavaScript");
await page.emulateMedia({ media: "print" });
check(await page.locator("#lab .lab-static").isVisible(), "a figure in print");

// Times, to be read, not to be held.
const moves = await page.evaluate(async () => {
  const input = document.querySelector('[data-lab="cfl"]'), times = [];
  for (let i = 0; i < 20; i++) {
    const before = performance.now();
    input.value = 300 + i;
    input.dispatchEvent(new Event("input", { bubbles: true }));
    await new Promise((done) => setTimeout(done, 0));
    await new Promise((done) => setTimeout(done, 0));
    times.push(performance.now() - before);
  }
  return times.sort((a, b) => a - b)[10];
});
console.log(`the first picture after ${page.opened} ms, a move of a slider in ${moves.toFixed(0)} ms`);
await browser.close();
assert.deepEqual(problems, []);
console.log(`lab: ${checks} passed, 0 failed`);
