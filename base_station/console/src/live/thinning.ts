/** Thinning of a trail's older part, as the station thins its own (base_station/core/state/trail.py): the
 * simplified path stays within a stated distance of the original.  Pure. */
import type { TrailPoint } from "../wire";

export const TRAIL_POINTS = 900;
const TOLERANCE_M = 0.5; // at first; doubled while too many points are left
const RECENT_POINTS = 300;
const OLDER_POINTS = 500;
const DOUBLINGS = 10;

/** The trail, thinned where it has become too long. */
export function bounded(trail: readonly TrailPoint[]): readonly TrailPoint[] {
  if (trail.length <= TRAIL_POINTS) return trail;
  let older = trail.slice(0, -RECENT_POINTS);
  let toleranceM = TOLERANCE_M;
  for (let i = 0; i < DOUBLINGS; i++, toleranceM *= 2) {
    older = simplified(older, toleranceM);
    if (older.length <= OLDER_POINTS) break;
  }
  return [...older.slice(-OLDER_POINTS), ...trail.slice(-RECENT_POINTS)];
}

/** By Douglas and Peucker (1973); points at changes of the floor and at gaps are kept. */
function simplified(points: readonly TrailPoint[], toleranceM: number): TrailPoint[] {
  const kept = new Set<number>();
  let begin = 0;
  points.forEach((point, i) => {
    const next = points[i + 1];
    if (next !== undefined && next[4] !== 1 && next[3] === point[3]) return;
    keep(points, begin, i, toleranceM, kept);
    begin = i + 1;
  });
  return points.filter((_, i) => kept.has(i));
}

/** Marks both ends, and between them the points that are too far from the marked ones. */
function keep(
  points: readonly TrailPoint[],
  first: number,
  last: number,
  toleranceM: number,
  kept: Set<number>,
): void {
  kept.add(first).add(last);
  const parts: [number, number][] = [[first, last]];
  for (let part = parts.pop(); part !== undefined; part = parts.pop()) {
    const [begin, end] = part;
    let [worst, worstM] = [begin, toleranceM];
    for (let i = begin + 1; i < end; i++) {
      const offM = offOf(points[i], points[begin], points[end]);
      if (offM > worstM) [worst, worstM] = [i, offM];
    }
    if (worst === begin) continue;
    kept.add(worst);
    parts.push([begin, worst], [worst, end]);
  }
}

/** Distance of a point from the straight line between two others. */
function offOf(at?: TrailPoint, begin?: TrailPoint, end?: TrailPoint): number {
  if (at === undefined || begin === undefined || end === undefined) return 0;
  const [way0, way1] = [end[1] - begin[1], end[2] - begin[2]];
  const [off0, off1] = [at[1] - begin[1], at[2] - begin[2]];
  const length2 = way0 ** 2 + way1 ** 2;
  const along = length2 === 0 ? 0 : Math.min(1, Math.max(0, (off0 * way0 + off1 * way1) / length2));
  return Math.hypot(off0 - along * way0, off1 - along * way1);
}
