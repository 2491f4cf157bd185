/** How a person is drawn on the plan: trail, mark with heading, label. */
import type { Urgency } from "../live/urgency";
import { age, planLabel } from "../format";
import { t } from "../language/translate";
import { faint, type Colours } from "./colours";
import type { Context } from "./sprites";

/** Data of one person for the plan. */
export interface Mark {
  name: string;
  initials: string;
  urgency: Urgency;
  chosen: boolean;
  down: boolean;
  old: boolean;
  ageMs: number;
  floor: string; // where it is not simply the one shown
  floorsUp: number; // from the floor shown; negative: down; 0: on it, or not known
  floorBadge: string;
  headingRad: number;
  headingKnown: boolean;
}

/** How many corners, and where the first is, in steps between two of them from straight down. */
const CORNERS: Partial<Record<Urgency, readonly [count: number, first: number]>> = {
  immediate: [8, 0.5],
  soon: [4, 0],
};
const RADIUS_PX = 13;
const DANGER_RADIUS_PX = 17; // has room for the initials beside "!"
const ARROW_PX = 10;
export const HALO_PX = 4;
/** Largest distance of any part of a mark from its middle. */
export const MARK_REACH_PX = DANGER_RADIUS_PX + ARROW_PX + 3;

/** How the way walked is drawn. */
export function trailLook({ chosen, urgency }: Mark, colours: Colours): { color: string; widthPx: number } {
  const colour = chosen ? colours.chosen : colours[urgency];
  return { color: faint(colour, chosen ? 0.95 : 0.55), widthPx: chosen ? 3.5 : 2.5 };
}

/** Old marks are pale, except of members in danger. */
export function colourOf({ old, urgency }: Mark, colours: Colours): string {
  return old && urgency !== "immediate" ? colours.quiet : colours[urgency];
}

/** In the mark: "!" is danger, "?" an old position.  Several members in danger are distinguished by their
 * initials. */
export function lettersOf({ old, urgency, initials }: Pick<Mark, "old" | "urgency" | "initials">): string {
  const danger = urgency === "immediate";
  if (old && !danger) return "?";
  return danger ? `!${old ? "?" : ""}${initials}` : initials;
}

/** Only current marks on the shown floor are filled. */
export function isHollow({ old, floorsUp }: Pick<Mark, "old" | "floorsUp">): boolean {
  return old || floorsUp !== 0;
}

export function labelOf(mark: Mark): string {
  const words = [planLabel(mark.name), mark.floor, mark.old ? t("measure.old", { age: age(mark.ageMs) }) : ""];
  return words.filter((word) => word !== "").join(", ");
}

export function labelFont(mark: Mark): string {
  return `${isStrong(mark) ? "700" : "600"} 14px system-ui, sans-serif`;
}

/** Always named. */
export function isStrong({ chosen, urgency }: Mark): boolean {
  return chosen || urgency === "immediate";
}

/** Draws the name with its middle at the origin. */
export function drawName(context: Context, mark: Mark, colours: Colours): void {
  context.font = labelFont(mark);
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.lineJoin = "round";
  context.lineWidth = HALO_PX;
  context.strokeStyle = colours.halo;
  context.strokeText(labelOf(mark), 0, 0);
  context.fillStyle = colours.text;
  context.fillText(labelOf(mark), 0, 0);
}

/** Drawing order above others: the chosen member, then members in danger. */
export function rankOf({ chosen, urgency }: Mark): number {
  if (chosen) return 3;
  return urgency === "immediate" ? 2 : 1;
}

/** Key of the appearance of a mark, without its heading. */
export function looksOf(mark: Mark): string {
  const { urgency, chosen, old, floorBadge } = mark;
  return [urgency, chosen, isHollow(mark), old, lettersOf(mark), floorBadge].join(" ");
}

/** Without its heading, its middle at the origin. */
export function drawMark(context: Context, mark: Mark, colours: Colours): void {
  const colour = colourOf(mark, colours);
  const radiusPx = radiusOf(mark);
  const hollow = isHollow(mark);
  outline(context, mark.urgency, radiusPx);
  context.fillStyle = hollow ? colours.halo : colour;
  context.fill();
  context.lineWidth = mark.chosen ? 4 : hollow ? 2.5 : 2;
  context.strokeStyle = mark.chosen ? colours.chosen : hollow ? colour : colours.halo;
  if (mark.old) context.setLineDash([4, 3]);
  context.stroke();
  context.fillStyle = hollow ? colour : colours.halo;
  context.font = "700 12px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(lettersOf(mark), 0, 0.5, 2 * radiusPx - 4);
  drawFloorBadge(context, mark.floorBadge, radiusPx, colour, colours.halo);
}

export function radiusOf({ urgency }: Pick<Mark, "urgency">): number {
  return urgency === "immediate" ? DANGER_RADIUS_PX : RADIUS_PX;
}

/** Urgency as a shape, where colours look alike: immediate is an octagon, soon a square on its corner,
 * others are round. */
function outline(context: Context, urgency: Urgency, radiusPx: number): void {
  context.beginPath();
  const corners = CORNERS[urgency];
  if (corners === undefined) {
    context.arc(0, 0, radiusPx, 0, 2 * Math.PI);
    return;
  }
  const [count, first] = corners;
  const rimPx = radiusPx / Math.cos(Math.PI / count) ** 0.5; // as large as the circle
  for (let i = 0; i < count; i++) {
    const angle = (first + i) * ((2 * Math.PI) / count);
    context.lineTo(rimPx * Math.sin(angle), rimPx * Math.cos(angle));
  }
  context.closePath();
}

/** At the upper right of the mark. */
function drawFloorBadge(context: Context, text: string, radiusPx: number, colour: string, halo: string): void {
  if (text === "") return;
  context.font = "800 13px system-ui, sans-serif";
  context.textAlign = "left";
  context.setLineDash([]);
  context.lineJoin = "round";
  context.lineWidth = 4;
  context.strokeStyle = halo;
  context.strokeText(text, radiusPx * 0.7, -radiusPx);
  context.fillStyle = colour;
  context.fillText(text, radiusPx * 0.7, -radiusPx);
}

/** A point on the rim, towards the heading (clockwise from north, which is up). */
export function drawArrow(
  context: Context,
  headingRad: number,
  radiusPx: number,
  colour: string,
  halo: string,
): void {
  context.rotate(headingRad);
  context.beginPath();
  context.moveTo(0, -radiusPx - ARROW_PX);
  context.lineTo(8, -radiusPx + 2);
  context.lineTo(-8, -radiusPx + 2);
  context.closePath();
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = halo;
  context.stroke();
  context.fillStyle = colour;
  context.fill();
}
