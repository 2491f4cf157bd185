/* Keeps the page itself, and nothing that the station knows: what is behind /api never comes here.  The page
 * is asked for at the station each time, so that a new version replaces the old one at once; only a station
 * that does not answer leaves the page that was kept, which then says so. */
const SHELL = "muster-shell";
const PAGE = "/";
/** Longer than a slow link takes; the browser itself would wait for minutes. */
const AWAY_AFTER_MS = 8_000;

self.addEventListener("install", (event) => {
  self.skipWaiting();
  event.waitUntil(fetch(PAGE, { cache: "no-cache" }).then(keep));
});

self.addEventListener("activate", (event) => event.waitUntil(self.clients.claim()));

self.addEventListener("fetch", (event) => {
  const { request } = event;
  const url = new URL(request.url);
  if (request.method !== "GET" || url.origin !== self.location.origin) return;
  if (request.mode === "navigate" && url.pathname === PAGE) event.respondWith(page(event));
  else if (url.pathname.startsWith("/assets/") || url.pathname === "/icon.svg") event.respondWith(part(request));
});

async function page(event) {
  try {
    const answer = await fetch(event.request, { signal: AbortSignal.timeout(AWAY_AFTER_MS) });
    event.waitUntil(keep(answer.clone()));
    return answer;
  } catch (error) {
    const kept = await caches.match(PAGE, { cacheName: SHELL });
    if (kept === undefined) throw error;
    return kept;
  }
}

/** Files below /assets change their name with what is in them: what is kept is right. */
async function part(request) {
  return (await caches.match(request, { cacheName: SHELL })) ?? fetch(request);
}

/** The page last, once all of its parts are kept; then what belonged to an earlier one goes. */
async function keep(answer) {
  if (!answer.ok) return;
  const shell = await caches.open(SHELL);
  const links = (await answer.clone().text()).matchAll(/(?:src|href)="(\/[^"]+)"/g);
  const parts = new Set([...links].map(([, path]) => path));
  for (const path of parts) {
    if ((await shell.match(path)) === undefined) await shell.add(path);
  }
  await shell.put(PAGE, answer);
  for (const { url } of await shell.keys()) {
    const { pathname } = new URL(url);
    if (pathname !== PAGE && !parts.has(pathname)) await shell.delete(url);
  }
}
