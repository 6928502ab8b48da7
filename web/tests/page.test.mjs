// The page in a browser, as a person has it: the address, the status line for screen readers and pictures tell what
// happens. PLAYWRIGHT is the folder in which playwright-core is installed, BROWSER a Chromium.

import assert from "node:assert/strict";
import { createReadStream, existsSync, mkdirSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

const { chromium } = await import(join(process.env.PLAYWRIGHT, "node_modules/playwright-core/index.mjs"));
const dist = fileURLToPath(new URL("../dist/", import.meta.url));
const pictures = process.env.PICTURES;
const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".png": "image/png" };
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
  browser = await chromium.launch({ executablePath: process.env.BROWSER ?? "/usr/bin/chromium", args: arguments_ });
  if (pictures) mkdirSync(pictures, { recursive: true });
});

after(async () => {
  await browser?.close();
  server?.close();
});

async function open(link = "", options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  const problems = [];
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  await page.goto(address + link);
  await page.waitForSelector("#start", { state: "detached", timeout: 60_000 });
  return { context, page, problems };
}

const status = (page) => page.textContent("#status");
const says = (page, words) =>
  page.waitForFunction((words) => document.querySelector("#status").textContent.includes(words), words, { timeout: 60_000 });
const addressHas = (page, words) => page.waitForFunction((words) => location.href.includes(words), words, { timeout: 30_000 });

// Drags the slider of the amplitude over these places.
async function drag(page, [from, ...to]) {
  await page.mouse.move(from, 133);
  await page.mouse.down();
  for (const x of to) await page.mouse.move(x, 133, { steps: 2 });
  await page.mouse.up();
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

test("a finger drags a slider", async () => {
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
  await page.evaluate((text) => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([text], "dropped.ron"));
    const canvas = document.querySelector("canvas");
    for (const type of ["dragover", "drop"]) {
      canvas.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
    }
  }, text);
  await page.waitForFunction(() => document.title.startsWith("Dropped here"), null, { timeout: 30_000 });
  await drag(page, [104, 98, 92]);
  const download = page.waitForEvent("download", { timeout: 30_000 });
  await page.keyboard.press("Control+s");
  const saved = await download;
  assert.equal(saved.suggestedFilename(), "dropped.ron");
  assert.match(readFileSync(await saved.path(), "utf8"), /Dropped here/);
  assert.deepEqual(problems, []);
  await context.close();
});

test("a map is computed by workers and no frame waits for it", async () => {
  const { context, page, problems } = await open("?scene=paper");
  await says(page, "cross");
  await page.evaluate(() => {
    window.longest = 0;
    let last = performance.now();
    const look = () => {
      const now = performance.now();
      window.longest = Math.max(window.longest, now - last);
      last = now;
      requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
  await page.mouse.click(640, 300);
  await page.keyboard.press("Control+3");
  await page.waitForTimeout(10_000);
  const longest = await page.evaluate(() => window.longest);
  await picture(page, "map");
  console.log(`the longest frame beside a map: ${longest.toFixed(0)} ms`);
  assert.deepEqual(problems, []);
  await context.close();
});

test("the back button opens the scene before", async () => {
  const { context, page } = await open("?scene=paper");
  await says(page, "cross");
  await page.evaluate(() => (location.hash = ""));
  await page.evaluate(() => history.pushState(null, "", "?scene=harvester") ?? dispatchEvent(new PopStateEvent("popstate")));
  await page.waitForFunction(() => /^Power from/.test(document.title), null, { timeout: 30_000 });
  await page.goBack();
  await page.waitForFunction(() => /Prototype/.test(document.title), null, { timeout: 30_000 });
  await context.close();
});

test("a lesson opens by its link", async () => {
  const { context, page, problems } = await open("?lesson=02-shake-it-over");
  await page.waitForTimeout(2_000);
  await picture(page, "lesson");
  assert.deepEqual(problems, []);
  await context.close();
});

test("a faulty link is said in the window and harms nothing", async () => {
  const { context, page, problems } = await open("?scene=paper#not-a-link");
  await page.waitForTimeout(1_500);
  await picture(page, "faulty");
  await page.keyboard.press("Escape");
  await addressHas(page, "?scene=");
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
      await page.waitForTimeout(2_500);
      await picture(page, `${name}-${colorScheme}`);
      assert.deepEqual(problems, []);
      await context.close();
    });
  }
}
