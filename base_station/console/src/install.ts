/** The page can be installed, and opens without its station to say that it is away.  Browsers allow that over
 * TLS and on the station's own machine. */
export function install(): void {
  if (!("serviceWorker" in navigator)) return;
  // Without it the page works all the same; the browser logs the error.
  navigator.serviceWorker.register("/sw.js").catch((error: unknown) => console.warn(error));
}
