/** The region where a person is with 95 % probability, and when a position is old.  Pure. */
import type { PositionView } from "../wire";

/** As the station widens the region of a unit that it cannot hear (base_station/views/units.py). */
const ROAMING_MPS = 1.0;
const ROAMING_MOST_M = 250;
/** From this age a position is marked as old everywhere. */
export const OLD_MS = 10_000;
const SIDES = 48;
/** Sine and cosine to each corner of a ring, which is closed by the first one: rings are drawn for hundreds of
 * people, many times a second. */
const CORNERS = Array.from({ length: SIDES + 1 }, (_, i) => {
  const turn = (2 * Math.PI * (i % SIDES)) / SIDES;
  return [Math.sin(turn), Math.cos(turn)] as const;
});

export interface Region {
  major_m: number;
  minor_m: number;
  heading_rad: number;
}

/** The station states the region of a unit that it does not receive; the console continues to widen it
 * while the station is not received. */
export function regionAt(position: PositionView, silentMs: number): Region {
  const roamedM = Math.min((ROAMING_MPS * silentMs) / 1000, ROAMING_MOST_M);
  return {
    major_m: position.ellipse_major_m + roamedM,
    minor_m: position.ellipse_minor_m + roamedM,
    heading_rad: position.ellipse_heading_rad,
  };
}

export function isOld(position: PositionView, nowMs: number): boolean {
  return nowMs - position.t_ms >= OLD_MS;
}

/** The possible region of a person: the reachable area within the walls of a wearer who is not received,
 * else the ellipse. */
export function outline(
  centre: readonly [number, number],
  position: PositionView,
  silentMs: number,
): [number, number][] {
  const { reach } = position;
  const [first] = reach;
  // While the station is silent the region grows, and only the ellipse is known to.
  if (first === undefined || silentMs > 0) return ring(centre, regionAt(position, silentMs));
  return [...reach, first];
}

/** A closed ring of `[east_m, north_m]` about a centre. */
export function ring(centre: readonly [number, number], region: Region): [number, number][] {
  const sin = Math.sin(region.heading_rad);
  const cos = Math.cos(region.heading_rad);
  return CORNERS.map(([sinOfTurn, cosOfTurn]) => {
    const along = region.major_m * cosOfTurn;
    const across = region.minor_m * sinOfTurn;
    return [centre[0] + along * sin + across * cos, centre[1] + along * cos - across * sin];
  });
}
