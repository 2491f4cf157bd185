/** Trails on one floor or on all: of every member for the last minutes, of some from the beginning. Pure. */
import type { Urgency } from "../live/urgency";
import type { FloorChoice } from "../uiState";
import type { TrailPoint } from "../wire";

export const TRAIL_MS = 5 * 60_000;
/** The complete trail is drawn for the chosen member and for members in danger until that is resolved: it
 * is the way to them.  For all members it would hide the plan. */
export function spanMs(chosen: boolean, urgency: Urgency = "normal"): number {
  return chosen || urgency === "immediate" ? Infinity : TRAIL_MS;
}
/** A member at rest leaves a point every 15 s; over a longer gap the path is unknown. */
export const GAP_MS = 20_000;

type Joined = (before: TrailPoint, point: TrailPoint) => boolean;
/** Limit for a stored trail, which states its gaps. */
export const joinedAsSaid: Joined = (_, point) => point[4] !== 1;
/** Limit for a trail with all its points. */
export const joinedByTime: Joined = (before, point) => point[0] - before[0] <= GAP_MS;

/** Lines of `[east_m, north_m]`, interrupted at changes of the floor and at gaps. */
export function trailLines(
  points: readonly TrailPoint[],
  nowMs: number,
  floor: FloorChoice,
  spanMs = TRAIL_MS,
  joined = joinedAsSaid,
): [number, number][][] {
  const lines: [number, number][][] = [];
  let line: [number, number][] = [];
  let last: TrailPoint | null = null;
  for (const point of points) {
    const [tMs, northM, eastM, on] = point;
    const shown = tMs >= nowMs - spanMs && (floor === "all" || on === null || on === floor);
    if (!shown) {
      last = null;
      continue;
    }
    if (last === null || !joined(last, point)) {
      line = [];
      lines.push(line);
    }
    line.push([eastM, northM]);
    last = point;
  }
  return lines.filter((one) => one.length > 1);
}
