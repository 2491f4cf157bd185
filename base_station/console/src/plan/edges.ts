/** Arrows at the plan's edge towards members in danger outside the view.  Pure. */
import { t } from "../language/translate";
import type { Box, Pixel } from "./names";

export interface Outside {
  unitId: string;
  name: string;
  initials: string;
  mark: Pixel; // from the plan's upper left corner, wherever that is
}

export interface EdgeMark extends Outside {
  at: Pixel; // the middle of what is drawn at the edge
  bearingRad: number; // towards the member, clockwise from up
}

/** Half of what is drawn there, and how far its middle is from the edge. */
const HALF_PX = 20;
const INSET_PX = 28;
/** A mark nearer to the edge than this is cut. */
const CUT_PX = 6;
const STEP_PX = 8;

/** Arrows for those outside the view; without overlap with each other and with controls, as near as
 * possible to the straight line to the member. */
export function edgeMarks(people: readonly Outside[], size: Pixel, covered: readonly Box[]): EdgeMark[] {
  const [right, down] = size;
  if (right <= 2 * INSET_PX || down <= 2 * INSET_PX) return [];
  const taken: Box[] = [...covered];
  return people
    .filter(({ mark }) => !isInView(mark, size))
    .map((one) => {
      const [x, y] = [one.mark[0] - right / 2, one.mark[1] - down / 2];
      const at = firstClear(alongOf([x, y], size), size, taken);
      taken.push(around(at));
      return { ...one, at, bearingRad: Math.atan2(x, -y) };
    });
}

function isInView([x, y]: Pixel, [right, down]: Pixel): boolean {
  return x >= CUT_PX && x <= right - CUT_PX && y >= CUT_PX && y <= down - CUT_PX;
}

/** The sides of the frame in which the marks stand. */
function frame([right, down]: Pixel): Pixel {
  return [right - 2 * INSET_PX, down - 2 * INSET_PX];
}

/** How far along the frame, clockwise from its upper left corner, the way from the middle towards
 * `offset` leaves it. */
function alongOf([x, y]: Pixel, size: Pixel): number {
  const [wide, high] = frame(size);
  const scale = 1 / Math.max((2 * Math.abs(x)) / wide, (2 * Math.abs(y)) / high);
  const [atX, atY] = [x * scale + wide / 2, y * scale + high / 2];
  if (Math.abs(x) * high <= Math.abs(y) * wide) {
    return y < 0 ? atX : wide + high + (wide - atX);
  }
  return x > 0 ? wide + atY : 2 * wide + high + (high - atY);
}

function pointAt(along: number, size: Pixel): Pixel {
  const [wide, high] = frame(size);
  const round = 2 * (wide + high);
  const s = ((along % round) + round) % round;
  const onFrame: Pixel =
    s <= wide
      ? [s, 0]
      : s <= wide + high
        ? [wide, s - wide]
        : s <= 2 * wide + high
          ? [2 * wide + high - s, high]
          : [0, round - s];
  return [onFrame[0] + INSET_PX, onFrame[1] + INSET_PX];
}

function firstClear(along: number, size: Pixel, taken: readonly Box[]): Pixel {
  const [wide, high] = frame(size);
  for (let apart = 0; apart <= wide + high; apart += STEP_PX) {
    for (const way of [apart, -apart]) {
      const at = pointAt(along + way, size);
      if (!taken.some((box) => meet(around(at), box))) return at;
    }
  }
  return pointAt(along, size); // there is no room at all
}

function around([x, y]: Pixel): Box {
  return [x - HALF_PX, y - HALF_PX, x + HALF_PX, y + HALF_PX];
}

function meet(a: Box, b: Box): boolean {
  return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}

const COMPASS = ["n", "ne", "e", "se", "s", "sw", "w", "nw"] as const;

/** North is up. */
export function compassWord(bearingRad: number): string {
  const eighths = Math.round(bearingRad / (Math.PI / 4));
  return t(`compass.${COMPASS[(eighths + 8) % 8] ?? "n"}`);
}
