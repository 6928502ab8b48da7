// A worker that answers the questions of the page, one after the other.

import init, { answer } from "./interwell.js";

// The files that an answer writes.
globalThis.interwell = { download: (name, bytes) => postMessage({ name, bytes: bytes.slice() }) };

let ready;

onmessage = async ({ data }) => {
  if (data.module !== undefined) {
    ready = init({ module_or_path: data.module });
    return;
  }
  try {
    await ready;
    const problem = answer(data.name, data.question, (part) => postMessage({ part }));
    postMessage({ problem });
  } catch (error) {
    postMessage({ problem: String(error) });
  }
};
