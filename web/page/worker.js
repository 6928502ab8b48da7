// A worker that answers the questions of the page, one after the other.

import init, { answer } from "./interwell.js";

let ready;

onmessage = async ({ data }) => {
  if (data.module !== undefined) {
    ready = init({ module_or_path: data.module });
    return;
  }
  await ready;
  // parts that come fast are sent together
  let parts = [];
  let sent = performance.now();
  const send = () => {
    postMessage({ parts });
    parts = [];
    sent = performance.now();
  };
  const problem = answer(data.name, data.text, (part) => {
    parts.push(part);
    if (performance.now() - sent > 30) send();
  });
  if (problem !== undefined) console.error(problem);
  send();
  postMessage({});
};
