// Starts the program in the page: loads the module, has workers for its studies, and follows the address.

import init, { answer_part, open_link, open_window } from "./interwell.js";

const element = (id) => document.getElementById(id);

function fail(sentence) {
  element("says").textContent = sentence;
  element("progress").hidden = true;
}

// The bytes of the module, with progress. Its compressed size is not that of its bytes, so that the bar is full
// a little early or late.
async function load(address) {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: ${response.status} ${response.statusText}`);
  const whole = Number(response.headers.get("content-length")) || 10e6;
  let loaded = 0;
  const counted = new TransformStream({
    transform(part, out) {
      loaded += part.length;
      element("progress").value = Math.min(1, loaded / whole);
      out.enqueue(part);
    },
  });
  const headers = { "content-type": "application/wasm" };
  return WebAssembly.compileStreaming(new Response(response.body.pipeThrough(counted), { headers }));
}

// Workers that answer questions, one question at a time each. A question that is cancelled ends its worker, which
// cannot be told while it computes; another one takes its place.
const workers = { module: null, idle: [], busy: new Map(), waiting: [], next: 1 };
// at least two, so that a long study does not keep what the motion settles to waiting
const most = Math.max(2, (navigator.hardwareConcurrency || 2) - 1);

function hire() {
  const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
  worker.postMessage({ module: workers.module });
  return worker;
}

function work() {
  while (workers.waiting.length > 0 && workers.busy.size < most) {
    const question = workers.waiting.shift();
    const worker = workers.idle.pop() ?? hire();
    const end = () => {
      workers.busy.delete(question.id);
      work();
    };
    worker.onmessage = ({ data }) => {
      if (data.parts !== undefined) return data.parts.forEach((part) => answer_part(question.id, part));
      workers.idle.push(worker);
      end();
      answer_part(question.id);
    };
    worker.onerror = (event) => {
      console.error(event.message);
      worker.terminate();
      end();
      answer_part(question.id);
    };
    workers.busy.set(question.id, worker);
    worker.postMessage(question);
  }
}

globalThis.interwell = {
  ask(name, text) {
    const id = workers.next++;
    workers.waiting.push({ id, name, text });
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
  download(name, bytes) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  },
  // The address, the title and the status follow the scene.
  show(link, title, status) {
    if (link !== "" && link !== location.search + location.hash) history.replaceState(null, "", link);
    if (document.title !== title) document.title = title;
    if (element("status").textContent !== status) element("status").textContent = status;
  },
};

function asked() {
  return location.search + location.hash;
}

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
