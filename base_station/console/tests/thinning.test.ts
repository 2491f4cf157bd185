import { describe, expect, it } from "vitest";
import { bounded, TRAIL_POINTS } from "../src/live/thinning";
import type { TrailPoint } from "../src/wire";

/** A walk through rooms: a corner every 20 s, a metre a second. */
function rooms(seconds: number): TrailPoint[] {
  const trail: TrailPoint[] = [];
  let [north, east] = [0, 0];
  for (let s = 0; s < seconds; s++) {
    trail.push([s * 1000, north, east, s < seconds / 2 ? 0 : 1]);
    const turn = Math.floor(s / 20) % 3;
    north += turn === 0 ? 1 : turn === 1 ? 0 : -0.7;
    east += turn === 1 ? 1 : 0.1;
  }
  return trail;
}

function offOf(at: TrailPoint, trail: readonly TrailPoint[]): number {
  let nearest = Infinity;
  trail.slice(1).forEach((end, i) => {
    const begin = trail[i] ?? end;
    for (let part = 0; part <= 1; part += 0.02) {
      const north = begin[1] + part * (end[1] - begin[1]);
      const east = begin[2] + part * (end[2] - begin[2]);
      nearest = Math.min(nearest, Math.hypot(at[1] - north, at[2] - east));
    }
  });
  return nearest;
}

describe("a trail that has become too long", () => {
  it("keeps its beginning, its last minutes and the way between within half a metre", () => {
    const whole = rooms(TRAIL_POINTS + 1);
    const thinned = bounded(whole);
    expect(thinned.length).toBeLessThan(TRAIL_POINTS / 2);
    expect(thinned[0]).toEqual(whole[0]);
    expect(thinned.slice(-300)).toEqual(whole.slice(-300));
    for (const at of whole.filter((_, i) => i % 7 === 0)) expect(offOf(at, thinned)).toBeLessThan(0.52);
  });

  it("keeps where the floor changed and where nothing was heard", () => {
    const whole = rooms(TRAIL_POINTS + 1);
    const [tMs, north, east, floor] = whole[333] as TrailPoint;
    const gap: TrailPoint = [tMs, north, east, floor, 1];
    whole[333] = gap;
    const thinned = bounded(whole);
    expect(thinned).toContainEqual(gap);
    expect(thinned).toContainEqual(whole[332]);
    expect(thinned.find((point) => point[3] === 1)).toEqual(whole[451]);
  });

  it("is left as it is while it is not", () => {
    const short = rooms(TRAIL_POINTS);
    expect(bounded(short)).toBe(short);
  });
});
