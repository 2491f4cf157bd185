/** How long this page takes to show something, so that what is only pleasant is left out where that is long. */

/** Of the newest message in the mean of all. */
const WEIGHT = 0.2;
/** From here on, motion that is to please takes time from presses. */
const SLOW_MS = 60;

let meanMs = 0;

/** A message took so long until it was on the screen. */
export function noteFrame(ms: number): void {
  meanMs += WEIGHT * (ms - meanMs);
}

/** Whether the page has no time for motion. */
export function isSlow(): boolean {
  return meanMs > SLOW_MS;
}
