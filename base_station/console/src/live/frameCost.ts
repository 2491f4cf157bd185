/** Time that this page takes for an update; decorative motion is left out on a slow page. */

/** Weight of the newest message in the mean. */
const WEIGHT = 0.2;
/** Above this, decorative motion takes time from input. */
const SLOW_MS = 60;

let meanMs = 0;

/** Records the time from a message to the screen. */
export function noteFrame(ms: number): void {
  meanMs += WEIGHT * (ms - meanMs);
}

/** Whether the page has no time for motion. */
export function isSlow(): boolean {
  return meanMs > SLOW_MS;
}
