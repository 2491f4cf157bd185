/** Redrawing no more often than a drawing can be followed. */

export const REDRAW_MS = 200;

/** Do the work, at most once in each period, some time after it was asked for. */
export function atMostEvery(periodMs: number, work: () => void): { ask(): void; cancel(): void } {
  let timer: number | null = null;
  return {
    ask() {
      timer ??= window.setTimeout(() => {
        timer = null;
        work();
      }, periodMs);
    },
    cancel() {
      if (timer !== null) clearTimeout(timer);
    },
  };
}
