// Keeps a page of static files for when there is no network. With one, what it says is used.

const NAME = `phong ${registration.scope}`;

addEventListener("install", (event) => {
  skipWaiting();
  event.waitUntil(store());
});

addEventListener("activate", (event) => event.waitUntil(clients.claim()));

async function store() {
  const { files } = await (await fetch("files.json")).json();
  const cache = await caches.open(NAME);
  await cache.addAll(["./", "files.json", ...files]);
}

addEventListener("fetch", (event) => {
  const { request } = event;
  if (request.method !== "GET" || !request.url.startsWith(registration.scope)) return;
  event.respondWith(answer(event));
});

async function answer(event) {
  const { request } = event;
  const cache = await caches.open(NAME);
  try {
    const fresh = await fetch(request);
    // It is kept while the page has it already.
    if (fresh.ok) event.waitUntil(cache.put(request, fresh.clone()));
    return fresh;
  } catch (error) {
    const kept = await cache.match(request, { ignoreSearch: true });
    if (!kept) throw error;
    return kept;
  }
}
