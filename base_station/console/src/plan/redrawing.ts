/** Redrawing at most as often as there are changes, and as there is time for. */
import { isSlow } from "../live/frameCost";

/** As often as the station sends changes. */
const REDRAW_MS = 50;
const SLOW_REDRAW_MS = 200;
/** A slow drawing is repeated less often: this multiple of its duration is left to everything else. */
const REST = 4;

/** Shortest time between two drawings of the plan. */
export function redrawMs(): number {
  return isSlow() ? SLOW_REDRAW_MS : REDRAW_MS;
}

/** Runs the work soon after the request, and at most once in each period. */
export function atMostEvery(periodMs: () => number, work: () => void): { ask(): void; cancel(): void } {
  let timer: ReturnType<typeof setTimeout> | null = null;
  let beganMs = -Infinity;
  let tookMs = 0;
  const draw = () => {
    timer = null;
    beganMs = performance.now();
    work();
    tookMs = performance.now() - beganMs;
  };
  return {
    ask() {
      const nextMs = beganMs + Math.max(periodMs(), (1 + REST) * tookMs);
      timer ??= setTimeout(draw, Math.max(nextMs - performance.now(), 0));
    },
    cancel() {
      if (timer !== null) clearTimeout(timer);
    },
  };
}
