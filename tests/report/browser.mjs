// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
//   node browser.mjs CHROMIUM FOLDER [--pictures TO]
//
// What a reader does with a page, in a browser without a network. --pictures also takes a picture of
// each view, light and dark, 1280 and 400 pixels wide.
import assert from "node:assert/strict";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [executablePath, folder, option, pictures] = process.argv.slice(2);
const launch = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];
const browser = await chromium.launch({ executablePath, args: launch });
const faults = [];

/// A page of the folder, which may ask nothing and say nothing wrong.
async function open(name, settings = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, reducedMotion: "reduce", ...settings });
  const page = await context.newPage();
  page.setDefaultTimeout(20000);
  page.on("console", (message) => {
    if (message.type() === "error") faults.push(`${name}: console: ${message.text()}`);
  });
  page.on("pageerror", (error) => faults.push(`${name}: ${error.message}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) faults.push(`${name}: a request to ${request.url()}`);
  });
  await page.goto(pathToFileURL(join(folder, name)).href);
  await page.waitForSelector("html[data-ready]");
  return page;
}

/// How many different colours an element shows, coarsely.
async function colorsOf(page, locator) {
  const picture = (await locator.screenshot()).toString("base64");
  return page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const seen = new Set();
    for (let i = 0; i < data.length; i += 4) seen.add(`${data[i] >> 4} ${data[i + 1] >> 4} ${data[i + 2] >> 4}`);
    return seen.size;
  }, picture);
}

async function viewerOf(page) {
  await page.locator("#geometry").scrollIntoViewIfNeeded();
  await page.waitForSelector("#viewer canvas[data-ready]");
  return page.locator("#viewer canvas");
}

const labelsOf = (table) => table.locator("tbody th").allTextContents();

const tests = {
  async "a column sorts up and down, dashes stay below"() {
    const page = await open("benchmark.html");
    const table = page.locator("table.grid").first();
    const before = await labelsOf(table);
    const sort = table.locator("button.sort").nth(1);
    await sort.click();
    const values = await table.locator("tbody tr td:nth-child(2)").evaluateAll((cells) => cells.map((c) => c.dataset.value));
    const known = values.filter((v) => v !== undefined).map(Number);
    assert.deepEqual(known, [...known].sort((a, b) => a - b));
    assert.ok(values.indexOf(undefined) === -1 || values.indexOf(undefined) >= known.length);
    await sort.press("Enter");
    assert.equal(await table.locator("th[aria-sort=descending]").count(), 1);
    assert.deepEqual((await labelsOf(table)).sort(), before.sort());
  },

  async "a number explains itself by mouse and by keyboard"() {
    const page = await open("benchmark.html");
    const cell = page.locator("table.grid td b").first().locator("..");
    await cell.hover();
    const box = page.locator("#explanation");
    assert.match(await box.textContent(), /Variance of the log ratio.*convention.*n.*coverage/s);
    await page.mouse.move(0, 0);
    await cell.focus();
    await page.keyboard.press("Enter");
    await page.getByRole("button", { name: "Show this result alone" }).click();
    assert.equal(await page.locator("table.grid").first().locator("tbody tr:visible").count(), 1);
    await page.keyboard.press("Escape");
    assert.ok(await box.isHidden());
  },

  async "a scene alone leaves its figures"() {
    const page = await open("benchmark.html");
    const figures = page.locator("figure.figure:visible");
    const all = await figures.count();
    await page.locator(".filter select").first().selectOption("crane");
    const some = await figures.count();
    assert.ok(some > 0 && some < all, `${some} of ${all}`);
    await page.getByRole("button", { name: "All", exact: true }).click();
    assert.equal(await figures.count(), all);
  },

  async "a click on a timeline opens the frame"() {
    const page = await open("benchmark.html");
    const chart = page.locator("figure.timeline", { hasText: "Depth, sRMSE" }).first().locator(".u-over");
    await chart.scrollIntoViewIfNeeded();
    const box = await chart.boundingBox();
    const name = page.locator(".frame-name");
    const before = await name.textContent();
    await chart.click({ position: { x: box.width * 0.95, y: box.height * 0.5 } });
    await page.waitForFunction((text) => document.querySelector(".frame-name").textContent !== text, before);
    await page.waitForFunction(() => document.activeElement.type === "range");
    assert.ok(await colorsOf(page, page.locator("#triptych canvas").first()) > 20);
    const here = await name.textContent();
    await page.getByRole("button", { name: "next frame" }).click();
    assert.notEqual(await name.textContent(), here);
  },

  async "the geometry is drawn, turns, and tells of a click"() {
    const page = await open("benchmark.html");
    const canvas = await viewerOf(page);
    assert.ok(await colorsOf(page, canvas) > 30);
    const before = await canvas.screenshot();
    await canvas.focus();
    await page.keyboard.press("ArrowLeft");
    await page.waitForTimeout(200);
    assert.ok(!before.equals(await canvas.screenshot()));
    const box = await canvas.boundingBox();
    const told = page.locator("#viewer .readout");
    for (const [x, y] of [[0.5, 0.5], [0.45, 0.6], [0.55, 0.45], [0.5, 0.65]]) {
      await canvas.click({ position: { x: box.width * x, y: box.height * y } });
      if (!/^Click/.test(await told.textContent())) break;
    }
    assert.match(await told.textContent(), /(point|Face|Camera|distance)/);
  },

  async "two results stand side by side and turn together"() {
    const page = await open("benchmark.html");
    const canvas = await viewerOf(page);
    await page.getByLabel("beside it").selectOption({ index: 2 });
    await page.waitForSelector("#viewer canvas[data-ready='2']");
    await page.waitForTimeout(200);
    assert.equal(await page.locator(".pane-labels span").count(), 2);
    const box = await canvas.boundingBox();
    const halves = async () => {
      const clip = { y: box.y + 40, width: box.width / 2 - 4, height: box.height - 60 };
      return [await page.screenshot({ clip: { ...clip, x: box.x } }),
        await page.screenshot({ clip: { ...clip, x: box.x + box.width / 2 + 2 } })];
    };
    const [left, right] = await halves();
    await canvas.focus();
    await page.keyboard.press("ArrowUp");
    await page.waitForTimeout(200);
    const [leftAfter, rightAfter] = await halves();
    assert.ok(!left.equals(leftAfter) && !right.equals(rightAfter));
  },

  async "labels stay labels, and long ones do not widen the page"() {
    const page = await open("labels.html");
    await viewerOf(page);
    assert.equal(await page.evaluate(() => window.broken), undefined);
    assert.equal(await page.locator("img").count(), 0);
    assert.match(await page.title(), /<\/script>/);
    assert.match(await page.locator("footer").textContent(), /three \d.*uplot \d/s);
  },

  async "a narrow window scrolls down only"() {
    for (const name of ["benchmark.html", "labels.html", "compare.html"]) {
      const page = await open(name, { viewport: { width: 400, height: 800 } });
      const width = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(width <= 400, `${name}: ${width} pixels wide`);
    }
  },

  async "every picture and control has a name"() {
    const page = await open("benchmark.html");
    await viewerOf(page);
    const nameless = await page.evaluate(() => [...document.querySelectorAll("button, select, input, canvas[role], svg[role]")]
      .filter((e) => !(e.ariaLabel || e.textContent.trim() || e.labels?.[0]?.textContent.trim() || e.closest("label")))
      .map((e) => e.outerHTML.slice(0, 80)));
    assert.deepEqual(nameless, []);
  },

  async "differences of two results are tables and intervals"() {
    const page = await open("compare.html");
    assert.match(await page.locator("#overview").textContent(), /difference/);
    assert.ok(await page.locator("figure.interval svg").count() > 0);
    assert.ok(await page.locator("figure.timeline .u-over").count() > 0);
  },
};

async function takePictures() {
  for (const [width, colorScheme] of [[1280, "light"], [1280, "dark"], [400, "light"]]) {
    const name = (view) => join(pictures, `${view}-${width}-${colorScheme}.png`);
    const page = await open("benchmark.html", { viewport: { width, height: 900 }, colorScheme });
    await page.addStyleTag({ content: "#bar { position: static !important }" });
    await viewerOf(page);
    await page.waitForTimeout(500);
    for (const view of ["overview", "figures", "geometry", "frames", "notes", "provenance"]) {
      await page.locator(`#${view}`).screenshot({ path: name(view) });
    }
    await page.evaluate(() => scrollTo(0, 0));
    await page.screenshot({ path: name("top") });
    await page.getByLabel("beside it").selectOption({ index: 2 });
    await page.waitForSelector("#viewer canvas[data-ready='2']");
    await page.waitForTimeout(300);
    await page.locator("#geometry").screenshot({ path: name("beside") });
    const other = await open("compare.html", { viewport: { width, height: 900 }, colorScheme });
    await other.screenshot({ path: name("compare"), fullPage: true });
  }
}

let n_failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    await test();
  } catch (error) {
    ++n_failed;
    console.log(`FAILED: ${name}: ${error.message}`);
  }
  for (const context of browser.contexts()) await context.close();
}
for (const fault of new Set(faults)) console.log(`FAILED: ${fault}`);
if (option === "--pictures") await takePictures();
await browser.close();
const n = Object.keys(tests).length;
console.log(`${n - n_failed} passed, ${n_failed + faults.length} failed`);
process.exit(n_failed + faults.length === 0 ? 0 : 1);
