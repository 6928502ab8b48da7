// The page in a browser, as a person has it: the address, the status line for screen readers and pictures tell what
// happens. PLAYWRIGHT is the folder in which playwright-core is installed, BROWSER a Chromium or a Firefox, which draws
// WebGL2 only on a display (`xvfb-run`).

import assert from "node:assert/strict";
import { createReadStream, existsSync, mkdirSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

const { chromium, firefox } = await import(join(process.env.PLAYWRIGHT, "node_modules/playwright-core/index.mjs"));
const executablePath = process.env.BROWSER ?? "/usr/bin/chromium";
const inFirefox = executablePath.includes("firefox");
// the driver of Firefox reports neither
const noDownloads = inFirefox && "its driver reports no downloads";
const noTouches = inFirefox && "its driver has no touches";
const dist = fileURLToPath(new URL("../dist/", import.meta.url));
const pictures = process.env.PICTURES;
const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".png": "image/png" };
// heights of rows of the menu of files
const SAVE_THE_RUN = 280;
const SAVE_THE_EVENTS = 304;
const SAVE_THE_MAP = 376;
const arguments_ = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking"];

let server, browser, address;

before(async () => {
  server = createServer((request, response) => {
    const path = new URL(request.url, "http://localhost").pathname.replace(/^\/class/, "");
    const file = join(dist, path === "/" ? "index.html" : path);
    if (!existsSync(file)) return response.writeHead(404).end();
    response.setHeader("content-type", types[extname(file)] ?? "application/octet-stream");
    response.setHeader("content-length", readFileSync(file).length);
    createReadStream(file).pipe(response);
  });
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  // from a folder of a host
  address = `http://127.0.0.1:${server.address().port}/class/`;
  browser = await (inFirefox
    ? firefox.launch({ executablePath, channel: "moz-firefox", headless: false })
    : chromium.launch({ executablePath, args: arguments_ }));
  if (pictures) mkdirSync(pictures, { recursive: true });
});

after(async () => {
  await browser?.close();
  server?.close();
});

async function open(link = "", options = {}) {
  const viewport = { width: 1280, height: 720 };
  const context = await browser.newContext({ viewport, acceptDownloads: true, ...options });
  const page = await context.newPage();
  const problems = [];
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  // the names of the questions that workers are asked
  await page.addInitScript((processors) => {
    window.asked = [];
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message) {
      if (message.name) window.asked.push(message.name);
      post.call(this, message);
    };
    if (processors) Object.defineProperty(Navigator.prototype, "hardwareConcurrency", { get: () => processors });
  }, options.processors);
  await page.goto(address + link);
  await page.waitForSelector("#start", { state: "detached", timeout: 60_000 });
  return { context, page, problems };
}

const status = (page) => page.textContent("#status");
const says = (page, words) => page.waitForFunction(
  (words) => document.querySelector("#status").textContent.includes(words), words, { timeout: 60_000 });
const addressHas = (page, words) => page.waitForFunction(
  (words) => location.href.includes(words), words, { timeout: 30_000 });

// The address as the page has it: what a driver remembers of it can be old.
const place = (page) => page.evaluate(() => location.href);

// Drags the slider of the amplitude, at this height, over these places.
async function drag(page, [from, ...to], y = 133) {
  await page.mouse.move(from, y);
  await page.mouse.down();
  for (const x of to) await page.mouse.move(x, y, { steps: 2 });
  await page.mouse.up();
}

// What a key, pressed on the window, writes as a file.
async function written(page, key) {
  const download = page.waitForEvent("download", { timeout: 60_000 });
  await page.keyboard.press(key);
  return readFileSync(await (await download).path(), "utf8");
}

// The file that a row of the menu of files, at this height, writes.
async function fromMenu(page, y) {
  await page.mouse.click(22, 17);
  // where the processor draws, a frame may take long
  await page.waitForTimeout(2_000);
  const download = page.waitForEvent("download", { timeout: 30_000 });
  await page.mouse.click(90, y);
  return download;
}

async function drop(page, files) {
  await page.evaluate((files) => {
    const dataTransfer = new DataTransfer();
    files.forEach(([name, text]) => dataTransfer.items.add(new File([text], name)));
    const canvas = document.querySelector("canvas");
    for (const type of ["dragover", "drop"]) {
      canvas.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
    }
  }, files);
}

async function picture(page, name) {
  if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`) });
}

test("the first scene opens, moves and is judged by a worker", async () => {
  const { context, page, problems } = await open();
  await says(page, "well");
  assert.match(await page.title(), /interwell$/);
  await addressHas(page, "?scene=first-look");
  await picture(page, "first");
  assert.deepEqual(problems, []);
  await context.close();
});

test("a dragged slider is in the address, and the address opens the same scene elsewhere", async () => {
  const { context, page } = await open("?scene=paper");
  await says(page, "cross");
  const before = page.url();
  await drag(page, [83, 90, 96, 102, 108]);
  await addressHas(page, "?scene=paper#");
  const link = page.url();
  assert.notEqual(link, before);
  await says(page, "cross");
  const words = await status(page);
  await context.close();
  const other = await open(link.slice(address.length));
  await says(other.page, words.slice(0, 40));
  assert.equal(other.page.url(), link);
  await other.context.close();
});

test("a finger drags a slider", { skip: noTouches }, async () => {
  const { context, page } = await open("?scene=paper", { viewport: { width: 1024, height: 768 }, hasTouch: true });
  await says(page, "cross");
  const touch = await context.newCDPSession(page);
  const send = (type, x) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: x ? [{ x, y: 132 }] : [] });
  await send("touchStart", 83);
  for (const x of [92, 100, 108]) {
    await page.waitForTimeout(60);
    await send("touchMove", x);
  }
  await send("touchEnd");
  await addressHas(page, "?scene=paper#");
  await context.close();
});

test("a dropped scene opens, and a key writes it as a download", async () => {
  const { context, page, problems } = await open();
  await says(page, "well");
  // without comments, whose loss is asked about
  const preset = readFileSync(new URL("../../presets/monostable.ron", import.meta.url), "utf8");
  const text = preset.replace(/title: "[^"]*"/, 'title: "Dropped here"').replace(/^\s*\/\/.*$/gm, "");
  await drop(page, [["dropped.ron", text]]);
  await page.waitForFunction(() => document.title.startsWith("Dropped here"), null, { timeout: 30_000 });
  await drag(page, [104, 98, 92]);
  if (!noDownloads) {
    const download = page.waitForEvent("download", { timeout: 30_000 });
    await page.keyboard.press("Control+s");
    const saved = await download;
    assert.equal(saved.suggestedFilename(), "dropped.ron");
    assert.match(readFileSync(await saved.path(), "utf8"), /Dropped here/);
  }
  assert.deepEqual(problems, []);
  await context.close();
});

test("a map is divided among workers, and frames go on beside it", async () => {
  const tables = [];
  for (const processors of [1, 5]) {
    const { context, page, problems } = await open("?scene=paper", { processors });
    await says(page, "cross");
    await page.evaluate(() => {
      window.longest = window.frames_ = 0;
      let last = performance.now();
      const look = () => {
        const now = performance.now();
        window.longest = Math.max(window.longest, now - last);
        window.frames_ += 1;
        last = now;
        requestAnimationFrame(look);
      };
      requestAnimationFrame(look);
    });
    await page.mouse.click(640, 300);
    await page.keyboard.press("Control+3");
    await page.waitForTimeout(12_000);
    const [longest, frames] = await page.evaluate(() => [window.longest, window.frames_]);
    console.log(`${processors} processors: ${frames} frames, the longest ${longest.toFixed(0)} ms`);
    assert.ok(frames > 20, `${frames} frames`);
    // all processors but two have had parts of the map
    const parts = await page.evaluate(() => window.asked.filter((name) => name === "cells").length);
    const share = Math.max(1, processors - 2);
    assert.ok(parts >= share, `${parts} parts`);
    await picture(page, `map-${processors}`);
    if (!noDownloads) {
      const file = await fromMenu(page, SAVE_THE_MAP);
      assert.equal(file.suggestedFilename(), "scene-map.csv");
      tables.push(readFileSync(await file.path(), "utf8"));
    }
    assert.deepEqual(problems, []);
    await context.close();
  }
  if (noDownloads) return;
  assert.ok(tables[0].split("\n").length > 2000);
  assert.equal(tables[0], tables[1]);
});

test("the back button undoes a change, and the button forward redoes it", async () => {
  const { context, page } = await open("?scene=paper");
  await says(page, "cross");
  await addressHas(page, "?scene=paper");
  const first = await place(page);
  await drag(page, [83, 90, 96]);
  await addressHas(page, "?scene=paper#");
  const second = await place(page);
  await drag(page, [96, 102, 108]);
  await page.waitForFunction((second) => location.href !== second, second);
  const third = await place(page);
  await page.evaluate(() => history.back());
  await page.waitForTimeout(1_500);
  assert.equal(await place(page), second);
  await page.evaluate(() => history.back());
  await page.waitForTimeout(1_500);
  assert.equal(await place(page), first);
  // no question whether to save, and nothing is undone any more
  await page.keyboard.press("Control+z");
  await page.waitForTimeout(1_500);
  assert.equal(await place(page), first);
  await page.evaluate(() => history.forward());
  await page.evaluate(() => history.forward());
  await page.waitForTimeout(1_500);
  assert.equal(await place(page), third);
  await page.keyboard.press("Control+z");
  await page.waitForFunction((second) => location.href === second, second);
  await context.close();
});

test("the back button opens the scene before", async () => {
  const { context, page } = await open("?scene=paper");
  await says(page, "cross");
  await page.evaluate(() => (location.hash = ""));
  await page.evaluate(() => {
    history.pushState(null, "", "?scene=harvester");
    dispatchEvent(new PopStateEvent("popstate"));
  });
  await page.waitForFunction(() => /^Power from/.test(document.title), null, { timeout: 30_000 });
  await page.evaluate(() => history.back());
  await page.waitForFunction(() => /Prototype/.test(document.title), null, { timeout: 30_000 });
  await context.close();
});

test("a lesson is done to its end, and that is kept", async () => {
  const { context, page, problems } = await open("?lesson=02-shake-it-over");
  await page.waitForFunction(() => document.title.startsWith("Shake it over"), null, { timeout: 30_000 });
  await addressHas(page, "?lesson=02-shake-it-over");
  await picture(page, "lesson");
  const next = async () => {
    await page.keyboard.press("PageDown");
    await page.waitForTimeout(700);
  };
  await next();
  await next();
  await says(page, "Covered");
  await page.keyboard.press("c");
  await says(page, "cross");
  await picture(page, "lesson-predicted");
  await next();
  await next();
  // the amplitude of the task
  await drag(page, [88, 120, 150, 180], 234);
  await says(page, "cross");
  await page.waitForTimeout(5_000);
  await picture(page, "lesson-task");
  for (let step = 0; step < 4; step += 1) await next();
  await picture(page, "lesson-end");
  await page.reload();
  await page.waitForSelector("#start", { state: "detached", timeout: 60_000 });
  assert.match(await page.evaluate(() => localStorage.getItem("lessons")), /02-shake-it-over.*done:\s*true/s);
  assert.deepEqual(problems, []);
  await context.close();
});

test("a faulty link is said in the window and harms nothing", async () => {
  const { context, page, problems } = await open("?scene=paper#not-a-link");
  await says(page, "is broken: copy the whole link");
  // the link is still there to be mended
  assert.match(page.url(), /#not-a-link$/);
  await picture(page, "faulty");
  await page.keyboard.press("Escape");
  await says(page, "well");
  assert.deepEqual(problems, []);
  await context.close();
});

test("what others append to a link changes nothing", async () => {
  const { context, page } = await open("?scene=paper&from=mail");
  await page.waitForFunction(() => document.title.startsWith("Prototype"), null, { timeout: 30_000 });
  await says(page, "cross");
  await context.close();
});

test("a worker computes the whole run and hands over its file", { skip: noDownloads }, async () => {
  const { context, page, problems } = await open("?scene=paper");
  await says(page, "cross");
  const file = await fromMenu(page, SAVE_THE_RUN);
  assert.equal(file.suggestedFilename(), "scene-run.csv");
  const rows = readFileSync(await file.path(), "utf8").trim().split("\n");
  // 10 s
  assert.match(rows[0], /^t_s,/);
  assert.match(rows.at(-1), /^10,/);
  assert.ok(await page.evaluate(() => window.asked.includes("run")));
  assert.deepEqual(problems, []);
  await context.close();
});

test("a figure is saved as a download", { skip: noDownloads }, async () => {
  const { context, page, problems } = await open("?scene=paper");
  await says(page, "cross");
  await page.mouse.move(640, 450);
  await page.keyboard.press("Control+e");
  await page.waitForTimeout(1_000);
  await picture(page, "figure");
  const figure = await written(page, "Enter");
  assert.match(figure, /^%PDF/);
  assert.ok(await page.evaluate(() => window.asked.includes("figure")));
  assert.deepEqual(problems, []);
  await context.close();
});

test("an export does not replace the table of the scene", { skip: noDownloads }, async () => {
  const { context, page, problems } = await open();
  await says(page, "well");
  const table = "x_m,force_n\n" + [...Array(41).keys()].map((i) => {
    const x = (i - 20) * 4e-4;
    return `${x},${-40 * x + 816326.5 * x ** 3}`;
  }).join("\n");
  const scene = (title) => `(title: "${title}", mass_g: 15.2,
    mechanism: Table(path: "pull-events.csv", tolerance: 1e-3),
    excitation: Sine(frequency_hz: 3, amplitude_g: 0.5), run: (duration_s: 5))`;
  const isCalled = (title) => page.waitForFunction(
    (title) => document.title.startsWith(title), title, { timeout: 30_000 });
  await drop(page, [["pull.ron", scene("Pulled")], ["pull-events.csv", table]]);
  await isCalled("Pulled");
  const file = await fromMenu(page, SAVE_THE_EVENTS);
  assert.equal(file.suggestedFilename(), "pull-events.csv");
  // the table is read again
  await drop(page, [["pull.ron", scene("Another")]]);
  await isCalled("Another");
  assert.deepEqual(problems, []);
  await context.close();
});

test("without a network the page opens again", async () => {
  const { context, page } = await open("?scene=paper");
  await page.evaluate(() => navigator.serviceWorker.ready);
  await page.waitForTimeout(1_000);
  await context.setOffline(true);
  await page.reload();
  await page.waitForSelector("#start", { state: "detached", timeout: 60_000 });
  await says(page, "cross");
  await context.close();
});

for (const [name, width, height] of [["phone", 390, 844], ["tablet", 1024, 768], ["desk", 1280, 720]]) {
  for (const colorScheme of ["light", "dark"]) {
    test(`${name}, ${colorScheme}`, async () => {
      const options = { viewport: { width, height }, colorScheme, hasTouch: name !== "desk" };
      const { context, page, problems } = await open("?scene=paper", options);
      await says(page, "cross");
      await picture(page, `${name}-${colorScheme}`);
      assert.deepEqual(problems, []);
      await context.close();
    });
  }
}
