/** How far from the plan's edges people are kept, in pixels, clockwise from the top.  Pure. */
import type { Pixel } from "./names";

export type Margins = readonly [top: number, right: number, bottom: number, left: number];

/** Room for names and the scale below, and on the right for the zoom buttons. */
const FIT: Margins = [40, 70, 60, 40];
/** Nearer to an edge than this a mark is cut, or lies under the buttons; a fit leaves a little more. */
const LEAST: Margins = [25, 68, 25, 25];
/** A plan smaller than this, as beside a panel on a phone, has no room for all of them. */
const WIDE_PX = 300;
const HIGH_PX = 220;
/** The middle part of the plan, of its width and of its height. */
const MIDDLE = 0.6;

export function fitMargins(size: readonly number[]): Margins {
  return scaled(FIT, size);
}

export function leastMargins(size: readonly number[]): Margins {
  return scaled(LEAST, size);
}

/** Whether a place on the plan, as far as it is drawn, is well away from the edges. */
export function isInMiddle(place: Pixel | null, size: readonly number[]): boolean {
  return place !== null && place.every((at, i) => Math.abs(at / (size[i] ?? 0) - 0.5) <= MIDDLE / 2);
}

function scaled([top, right, bottom, left]: Margins, [width = 0, height = 0]: readonly number[]): Margins {
  const [across, along] = [Math.min(1, width / WIDE_PX), Math.min(1, height / HIGH_PX)];
  return [top * along, right * across, bottom * along, left * across];
}
