/** Placement of people in a side section: at their heights, side by side or as a number where they would
 * cover each other.  Pure. */
import { isAlone, type Member } from "./members";

/** Left of a mark, for the bar of its height. */
export const BAR_PX = 8;

/** Where a person is in a drawing, in pixels from its upper left corner. */
export interface Place {
  footXPx: number;
  footYPx: number;
  barTopPx: number; // the height with its error
  barBottomPx: number;
  beyond: -1 | 0 | 1; // left of what is drawn, on it, right of it
}

/** The drawing in which marks stand. */
export interface Sheet {
  widthPx: number;
  heightPx: number;
  leftPx: number; // where marks may stand
  rightPx: number;
  aside: readonly Step[]; // where a mark may stand, its own place first
  placeOf(member: Member): Place;
}

/** In marks, from a person's place. */
export type Step = readonly [right: number, down: number];

/** One person, or several as a number. */
export interface SectionMark extends Place {
  key: string; // of the first of them, who keeps it
  members: readonly Member[];
  floor: number | null;
  xPx: number; // the middle, beside the place where others are in the way
  yPx: number;
}

const RANK = { immediate: 1, soon: 2, watch: 3, normal: 4 } as const;

/** Largest distance, in steps of a mark, at which a person joins others for lack of room. */
const JOIN_STEPS = 3;

/** Members in need and the chosen one first: they have a mark of their own, shifted if necessary; others
 * join the marks of their floor. */
export function sectionMarks(members: readonly Member[], sheet: Sheet, markPx: number): SectionMark[] {
  const stepPx = markPx + BAR_PX;
  const placed: SectionMark[] = [];
  const isFree = (mark: SectionMark) =>
    isOn(mark, sheet, markPx) && !placed.some((other) => meet(mark, other, stepPx, markPx));
  for (const member of [...members].sort((a, b) => rankOf(a) - rankOf(b))) {
    const alone = markOf(member, sheet, markPx);
    const aside = sheet.aside.map(([right, down]) => moved(alone, right * stepPx, down * markPx));
    const own = (isAlone(member) ? aside : aside.slice(0, 1)).find(isFree);
    if (own === undefined && joinNearest(placed, alone, JOIN_STEPS * stepPx)) continue;
    const beside = own ?? aside.find(isFree);
    if (beside === undefined && joinNearest(placed, alone, Infinity)) continue;
    placed.push(beside ?? alone);
  }
  return placed;
}

function rankOf(member: Member): number {
  return member.chosen ? 0 : RANK[member.urgency];
}

function markOf(member: Member, sheet: Sheet, markPx: number): SectionMark {
  const place = sheet.placeOf(member);
  return {
    ...place,
    key: member.unitId,
    members: [member],
    floor: member.floor,
    xPx: place.footXPx,
    yPx: place.footYPx - markPx / 2, // they stand on their height
  };
}

/** Joins the nearest mark of the same floor, preferably one without a reserved mark.  False: there is
 * none near enough. */
function joinNearest(placed: SectionMark[], mark: SectionMark, nearPx: number): boolean {
  const own = mark.members.some(isAlone);
  let [best, nearest] = [-1, nearPx];
  placed.forEach((other, i) => {
    const apartPx = Math.hypot(mark.xPx - other.xPx, mark.yPx - other.yPx);
    if (other.floor !== mark.floor || other.members.some(isAlone) !== own) return;
    if (apartPx < nearest) [best, nearest] = [i, apartPx];
  });
  const host = placed[best];
  if (host === undefined) return false;
  placed[best] = joined(host, mark);
  return true;
}

function moved(mark: SectionMark, rightPx: number, downPx: number): SectionMark {
  return { ...mark, xPx: mark.xPx + rightPx, yPx: mark.yPx + downPx };
}

function joined(host: SectionMark, one: SectionMark): SectionMark {
  return {
    ...host,
    members: [...host.members, ...one.members],
    barTopPx: Math.min(host.barTopPx, one.barTopPx),
    barBottomPx: Math.max(host.barBottomPx, one.barBottomPx),
  };
}

function meet(a: SectionMark, b: SectionMark, widthPx: number, heightPx: number): boolean {
  return Math.abs(a.xPx - b.xPx) < widthPx && Math.abs(a.yPx - b.yPx) < heightPx;
}

function isOn({ xPx, yPx }: SectionMark, sheet: Sheet, markPx: number): boolean {
  const half = markPx / 2;
  return (
    xPx >= sheet.leftPx - half && xPx <= sheet.rightPx + half && yPx >= half && yPx <= sheet.heightPx - half
  );
}
