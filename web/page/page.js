// Starts the program in the page: loads the module, has workers for its studies, and follows the address.

import init, { answer_part, open_link, open_window } from "./interwell.js";

const element = (id) => document.getElementById(id);

// Whether the scene that is open has a link.
let hasLink = true;

function fail(sentence) {
  element("says").textContent = sentence;
  element("progress").hidden = true;
}

// The bytes of the module, with progress.
async function load(address) {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: ${response.status} ${response.statusText}`);
  // without the size of the module itself, as where it comes compressed, the bar says only that it loads
  const isPlain = response.headers.get("content-encoding") === null;
  const whole = isPlain ? Number(response.headers.get("content-length")) : 0;
  let loaded = 0;
  const counted = new TransformStream({
    transform(part, out) {
      loaded += part.length;
      if (whole > 0) element("progress").value = loaded / whole;
      out.enqueue(part);
    },
  });
  const headers = { "content-type": "application/wasm" };
  return WebAssembly.compileStreaming(new Response(response.body.pipeThrough(counted), { headers }));
}

// Workers that answer questions, one question at a time each. A question that is cancelled ends its worker, which
// cannot be told while it computes; another one takes its place.
const workers = { module: null, idle: [], busy: new Map(), waiting: [], next: 1 };
// Into how many questions a long one is divided: all processors but two. Two workers more are for the questions that
// come meanwhile, such as what the motion settles to.
const share = Math.max(1, (navigator.hardwareConcurrency || 2) - 2);
const most = share + 2;

function hire() {
  const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
  worker.postMessage({ module: workers.module });
  return worker;
}

function work() {
  while (workers.waiting.length > 0 && workers.busy.size < most) {
    const question = workers.waiting.shift();
    const worker = workers.idle.pop() ?? hire();
    const end = (problem) => {
      workers.busy.delete(question.id);
      if (problem === undefined) workers.idle.push(worker);
      else {
        worker.terminate();
        failed(problem);
      }
      work();
      answer_part(question.id);
    };
    worker.onmessage = ({ data }) => {
      if (data.part) answer_part(question.id, data.part);
      else if (data.name) globalThis.interwell.download(data.name, data.bytes);
      else end(data.problem);
    };
    worker.onerror = (event) => end(event.message ?? "a worker did not load");
    workers.busy.set(question.id, worker);
    worker.postMessage(question);
  }
}

globalThis.interwell = {
  ask(name, question) {
    const id = workers.next++;
    // a copy, since the bytes lie in the memory of the module
    workers.waiting.push({ id, name, question: question.slice() });
    work();
    return id;
  },
  cancel(id) {
    workers.waiting = workers.waiting.filter((question) => question.id !== id);
    const worker = workers.busy.get(id);
    if (worker === undefined) return;
    worker.terminate();
    workers.busy.delete(id);
    work();
  },
  share: () => share,
  download(name, bytes) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  },
  // The address, the title and the status follow the scene; a change of it is a step of the history. An empty link
  // is that of a scene which has none, without a link the address stays.
  show(link, title, status, isStep) {
    if (link !== undefined) hasLink = link !== "";
    if (link !== undefined && link !== asked()) {
      history[isStep ? "pushState" : "replaceState"](null, "", link || location.pathname);
    }
    if (document.title !== title) document.title = title;
    if (element("status").textContent !== status) element("status").textContent = status;
  },
};

// The link in the address, without what others append to it.
function asked() {
  const link = new URLSearchParams(location.search);
  const kind = ["scene", "lesson"].find((kind) => link.has(kind));
  return kind === undefined ? "" : `?${kind}=${link.get(kind)}${location.hash}`;
}

// Says that a part of the program has failed, over the window.
function failed(problem) {
  console.error(problem);
  element("problem").textContent =
    `A part of the program has failed (${problem}). Reload the page; what has a link in the address opens again.`;
  element("problem").hidden = false;
}

// Keys of the window that mean something else to a browser.
const keys = { plain: ["F1"], control: ["0", "1", "2", "3", "4", "5", "e", "m", "y", "+", "=", "-", "l"] };

async function start() {
  const canvas = element("window");
  if (document.createElement("canvas").getContext("webgl2") === null) {
    return fail(
      "This browser offers no WebGL2, which draws the window: switch it on, take another browser, or install " +
        "the program on a desktop.",
    );
  }
  workers.module = await load(new URL("interwell_bg.wasm", import.meta.url));
  await init({ module_or_path: workers.module });
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  await open_window(canvas, location.origin + location.pathname, asked(), dark);
  element("start").remove();
  canvas.focus();
  const takes = ({ ctrlKey, metaKey, key }) => keys[ctrlKey || metaKey ? "control" : "plain"].includes(key);
  addEventListener("keydown", (event) => takes(event) && event.preventDefault(), { capture: true });
  // an observer of sizes reports so what it makes up for in the next frame
  addEventListener("error", (event) => event.message.startsWith("ResizeObserver") || failed(event.message));
  addEventListener("unhandledrejection", (event) => failed(event.reason));
  // what has a link is in the address
  addEventListener("beforeunload", (event) => !hasLink && document.title.startsWith("* ") && event.preventDefault());
  addEventListener("popstate", () => open_link(asked()));
  addEventListener("hashchange", () => open_link(asked()));
  if ("serviceWorker" in navigator) {
    navigator.serviceWorker.register(new URL("offline.js", import.meta.url)).catch((error) => console.warn(error));
  }
}

start().catch((error) => {
  console.error(error);
  fail(`The program cannot start: ${error.message ?? error}. Reload the page, or install it on a desktop.`);
});
