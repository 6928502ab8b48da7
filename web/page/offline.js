// Keeps the page for use without a network: what was fetched once is taken from the cache. A new version replaces it
// as a whole, once no page of the version before is open.

const cache = "interwell VERSION";
const files = ["./", "index.html", "page.js", "worker.js", "interwell.js", "interwell_bg.wasm", "icon.png", "manifest.webmanifest"];

addEventListener("install", (event) => {
  event.waitUntil(caches.open(cache).then((kept) => kept.addAll(files.map((file) => new Request(file, { cache: "reload" })))));
});

addEventListener("activate", (event) => {
  const old = (name) => name.startsWith("interwell ") && name !== cache;
  event.waitUntil(caches.keys().then((names) => Promise.all(names.filter(old).map((name) => caches.delete(name)))));
});

addEventListener("fetch", (event) => {
  if (event.request.method !== "GET") return;
  const kept = caches.open(cache).then((files) => files.match(event.request, { ignoreSearch: true }));
  event.respondWith(kept.then((file) => file ?? fetch(event.request)));
});
