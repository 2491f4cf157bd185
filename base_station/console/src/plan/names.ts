/** Placement of names on the plan: beside their marks, completely on the screen, over no mark and no
 * other name.  Pure. */

/** Pixels from the plan's upper left corner, or, of a name's middle, from its mark. */
export type Pixel = readonly [right: number, down: number];
export type Box = readonly [left: number, top: number, right: number, bottom: number];

/** The visible part of the plan. */
export interface Screen {
  size: Pixel;
  covered: readonly Box[]; // by what lies over the plan: a name there would not be read
  standing: readonly Box[]; // what is drawn on the plan, which a name would hide
  pixelOf(coordinate: number[]): Pixel | null; // null: nothing is drawn yet
}

/** The screen: nothing is drawn yet. */
export const BESIDE: Pixel = [-1, -1];

export interface Named {
  mark: Pixel;
  widthPx: number; // of the name
  strong: boolean; // in danger or chosen: named whatever that hides
  first: boolean; // of those: down or chosen, named before the others
  before: Side | null; // where the name stood last: it stays there while it can
}

export interface Place {
  side: Side;
  offset: Pixel;
}

export type Side = "below" | "above" | "right" | "left";

const SIDES: readonly Side[] = ["below", "above", "right", "left"];
const MARK_PX = 14;
const APART_PX = 25;
const HALF_LINE_PX = 9;
const EDGE_PX = 4;
/** With more people in danger, as after an evacuation whose PARs are all overdue, names over names
 * could not be read: only of the first ones. */
const MOST_STRONG = 12;

/** One for each person, null without a name: there is no room, or the person is outside the screen. */
export function placeNames(
  people: readonly Named[],
  { size: screen, covered, standing }: Omit<Screen, "pixelOf">,
): (Place | null)[] {
  const places = people.map((): Place | null => null);
  const marks = people.map(({ mark }) => around(mark, MARK_PX, MARK_PX));
  const strongMarks = marks.filter((_, i) => people[i]?.strong);
  const names: Box[] = [];
  const isFlood = strongMarks.length > MOST_STRONG;
  for (const turn of [isFirst, isStrong, isWeak]) {
    people.forEach((one, i) => {
      if (!turn(one) || !isOn(one.mark, screen)) return;
      const { first, strong } = one;
      const all = sidesFor(one.before).map((side) => placeAt(side, one, screen));
      const clearOf = (...taken: (readonly Box[])[]) =>
        all.find(({ offset }) => isClear(boxOf(one, offset), taken, screen)) ?? null;
      const inNeed = () =>
        clearOf(strongMarks, names, covered, standing) ??
        clearOf(strongMarks, names, covered) ??
        clearOf(names, covered) ??
        (isFlood && !first ? null : (clearOf() ?? placeAt("below", one, screen)));
      const found = clearOf(marks, names, covered, standing) ?? (strong ? inNeed() : null);
      if (found === null) return;
      places[i] = found;
      names.push(boxOf(one, found.offset));
    });
  }
  return places;
}

const isFirst = ({ first }: Named) => first;
const isStrong = ({ strong, first }: Named) => strong && !first;
const isWeak = ({ strong, first }: Named) => !strong && !first;

function sidesFor(before: Side | null): readonly Side[] {
  return before === null ? SIDES : [before, ...SIDES.filter((side) => side !== before)];
}

function placeAt(side: Side, one: Named, screen: Pixel): Place {
  return { side, offset: offsetTo(side, one, screen) };
}

/** Below and above its mark a name is shifted to stay on the screen; a name wider than the screen keeps
 * its left end. */
function offsetTo(side: Side, { mark: [x], widthPx }: Named, [right]: Pixel): Pixel {
  const half = widthPx / 2;
  if (side === "right") return [MARK_PX + EDGE_PX + half, 0];
  if (side === "left") return [-MARK_PX - EDGE_PX - half, 0];
  const middle = Math.max(Math.min(x, right - half - EDGE_PX), half + EDGE_PX);
  return [middle - x, side === "below" ? APART_PX : -APART_PX];
}

/** Area of a person's mark, and of the name if there is one. */
export function boxesOf(one: Named, place: Place | null): Box[] {
  const mark = around(one.mark, MARK_PX, MARK_PX);
  return place === null ? [mark] : [mark, boxOf(one, place.offset)];
}

function boxOf({ mark: [x, y], widthPx }: Named, [right, down]: Pixel): Box {
  return around([x + right, y + down], widthPx / 2, HALF_LINE_PX);
}

function around([x, y]: Pixel, halfWidth: number, halfHeight: number): Box {
  return [x - halfWidth, y - halfHeight, x + halfWidth, y + halfHeight];
}

function isOn([x, y]: Pixel, [right, down]: Pixel): boolean {
  return x >= 0 && x <= right && y >= 0 && y <= down;
}

/** Computed for hundreds of people, a few times a second. */
function isClear(box: Box, taken: readonly (readonly Box[])[], [right, down]: Pixel): boolean {
  if (box[0] < 0 || box[1] < 0 || box[2] > right || box[3] > down) return false;
  return !taken.some((boxes) => boxes.some((one) => meet(box, one)));
}

function meet(a: Box, b: Box): boolean {
  return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}
