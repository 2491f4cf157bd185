/** Where the name of somebody stands: under the mark, and where the screen ends there, still on it.  Pure. */

/** In pixels, from the plan's upper left corner; a name's is of its middle, from the mark's. */
export type Pixel = readonly [right: number, down: number];

const BELOW_PX = 25;
const HALF_LINE_PX = 10;
const EDGE_PX = 4;

export const UNDER: Pixel = [0, BELOW_PX];

/** Whoever is beside the screen is not named on it. */
export function nameAt(mark: Pixel, widthPx: number, [right, down]: Pixel): Pixel {
  const [x, y] = mark;
  if (x < 0 || x > right || y < 0 || y > down) return UNDER;
  const half = widthPx / 2 + EDGE_PX;
  const middle = Math.max(Math.min(x, right - half), half); // of two edges the left one: names begin there
  const hasRoomBelow = y + BELOW_PX + HALF_LINE_PX <= down;
  return [middle - x, hasRoomBelow ? BELOW_PX : -BELOW_PX];
}
