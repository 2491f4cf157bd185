/** How far from the plan's edges people are kept, in pixels, clockwise from the top.  Pure. */

export type Margins = readonly [top: number, right: number, bottom: number, left: number];

/** Room for names and the scale below, and on the right for the zoom buttons. */
const FIT: Margins = [40, 70, 60, 40];
/** Nearer to an edge than this a mark is cut, or lies under the buttons; a fit leaves a little more. */
const LEAST: Margins = [25, 68, 25, 25];
/** A plan smaller than this, as beside a panel on a phone, has no room for all of them. */
const WIDE_PX = 300;
const HIGH_PX = 220;

export function fitMargins(size: readonly number[]): Margins {
  return scaled(FIT, size);
}

export function leastMargins(size: readonly number[]): Margins {
  return scaled(LEAST, size);
}

function scaled([top, right, bottom, left]: Margins, [width = 0, height = 0]: readonly number[]): Margins {
  const [across, along] = [Math.min(1, width / WIDE_PX), Math.min(1, height / HIGH_PX)];
  return [top * along, right * across, bottom * along, left * across];
}
