/** Redrawing no more often than a drawing can be followed. */

export const REDRAW_MS = 200;
/** A slow drawing is repeated less often: this multiple of its duration is left to everything else. */
const REST = 4;

/** Runs the work at most once in each period, some time after the request. */
export function atMostEvery(periodMs: number, work: () => void): { ask(): void; cancel(): void } {
  let timer: ReturnType<typeof setTimeout> | null = null;
  let tookMs = 0;
  return {
    ask() {
      timer ??= setTimeout(() => {
        timer = null;
        const beganMs = performance.now();
        work();
        tookMs = performance.now() - beganMs;
      }, Math.max(periodMs, REST * tookMs));
    },
    cancel() {
      if (timer !== null) clearTimeout(timer);
    },
  };
}
