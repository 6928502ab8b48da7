// Keeps the page for use without a network: what was fetched once is taken from the cache, and a new version
// replaces it as a whole.

const cache = "interwell VERSION";
const files = ["./", "index.html", "page.js", "worker.js", "interwell.js", "interwell_bg.wasm", "icon.png", "manifest.webmanifest"];

addEventListener("install", (event) => {
  skipWaiting();
  event.waitUntil(caches.open(cache).then((kept) => kept.addAll(files.map((file) => new Request(file, { cache: "reload" })))));
});

addEventListener("activate", (event) => {
  const old = (name) => name.startsWith("interwell ") && name !== cache;
  event.waitUntil(caches.keys().then((names) => Promise.all(names.filter(old).map((name) => caches.delete(name)))));
});

addEventListener("fetch", (event) => {
  if (event.request.method !== "GET") return;
  event.respondWith(caches.match(event.request, { ignoreSearch: true }).then((kept) => kept ?? fetch(event.request)));
});
