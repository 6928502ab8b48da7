// A worker that answers the questions of the page, one after the other.

import init, { answer } from "./interwell.js";

let ready;

onmessage = async ({ data }) => {
  if (data.module !== undefined) {
    ready = init({ module_or_path: data.module });
    return;
  }
  await ready;
  const problem = answer(data.name, data.text, (part) => postMessage({ part }));
  if (problem !== undefined) console.error(problem);
  postMessage({});
};
