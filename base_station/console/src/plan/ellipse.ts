/** The region where a person is with 95 % probability, and how it grows with age.  Pure. */
import type { PositionView } from "../wire";

/** A person in gear moves no faster than this for long; the region of an old position grows so. */
export const GROWTH_MPS = 1.0;
/** Positions come several times a second: below this age nothing is missing. */
export const FRESH_MS = 2000;
/** From here a position is marked as old everywhere. */
export const OLD_MS = 10_000;
const LARGEST_M = 500;
const SIDES = 48;

export interface Region {
  major_m: number;
  minor_m: number;
  heading_rad: number;
}

export function regionAt(position: PositionView, nowMs: number): Region {
  const grownM = (GROWTH_MPS * Math.max(0, nowMs - position.t_ms - FRESH_MS)) / 1000;
  return {
    major_m: Math.min(position.ellipse_major_m + grownM, LARGEST_M),
    minor_m: Math.min(position.ellipse_minor_m + grownM, LARGEST_M),
    heading_rad: position.ellipse_heading_rad,
  };
}

export function isOld(position: PositionView, nowMs: number): boolean {
  return nowMs - position.t_ms >= OLD_MS;
}

/** A closed ring of `[east_m, north_m]` about a centre. */
export function ring(centre: readonly [number, number], region: Region): [number, number][] {
  const sin = Math.sin(region.heading_rad);
  const cos = Math.cos(region.heading_rad);
  return Array.from({ length: SIDES + 1 }, (_, i) => {
    const turn = (2 * Math.PI * (i % SIDES)) / SIDES;
    const along = region.major_m * Math.cos(turn);
    const across = region.minor_m * Math.sin(turn);
    return [centre[0] + along * sin + across * cos, centre[1] + along * cos - across * sin];
  });
}
