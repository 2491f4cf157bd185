/** The way walked in the last minutes, on one floor or on all.  Pure. */
import type { FloorChoice } from "../view";
import type { TrailPoint } from "../wire";

export const TRAIL_MS = 5 * 60_000;
/** While trails are compared, of a chosen person all of it is drawn; of everybody that would hide the
 * plan. */
export function spanMs(isChosen: boolean, compared: boolean): number {
  return isChosen && compared ? Infinity : TRAIL_MS;
}
/** Somebody at rest leaves a point every 15 s; over a longer gap nobody knows the way. */
const BREAK_MS = 20_000;

/** Lines of `[east_m, north_m]`, broken where the floor changes or nothing was heard. */
export function trailLines(
  points: readonly TrailPoint[],
  nowMs: number,
  floor: FloorChoice,
  spanMs = TRAIL_MS,
): [number, number][][] {
  const lines: [number, number][][] = [];
  let line: [number, number][] = [];
  let lastMs = -Infinity;
  for (const [tMs, northM, eastM, on] of points) {
    const shown = tMs >= nowMs - spanMs && (floor === "all" || on === null || on === floor);
    if (!shown) {
      lastMs = -Infinity;
      continue;
    }
    if (tMs - lastMs > BREAK_MS) {
      line = [];
      lines.push(line);
    }
    line.push([eastM, northM]);
    lastMs = tMs;
  }
  return lines.filter((one) => one.length > 1);
}
