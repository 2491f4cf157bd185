/** A side section as it is drawn: texts, and whole pixels, so that what did not change is not drawn again.
 * Pure. */
import { age, floorName, floorOf, planLabel, plusMinus, shortFloor } from "../format";
import { length, listed } from "../language/measures";
import { t } from "../language/translate";
import type { Urgency } from "../live/urgency";
import { compassWord } from "../plan/edges";
import { lettersOf } from "../plan/marks";
import { placeNames, type Box } from "../plan/names";
import type { Plan } from "../wire";
import { axisHeadingRad, floorSpans, placesOf, stairsOf, united, type AxisChoice, type Span } from "./axis";
import { frameOf, type Frame, type Size } from "./frame";
import { groundHeightM, storeyHeightM, type Level } from "./levels";
import { sectionMarks, type SectionMark } from "./marks";
import { isStrong, membersOf, type Member, type Scene } from "./members";

export interface DrawnMark {
  key: string;
  letters: string;
  words: string; // read aloud, and shown to who points at it
  urgency: Urgency;
  chosen: boolean;
  old: boolean;
  members: readonly { unitId: string; words: string }[];
  xPx: number;
  yPx: number;
  footXPx: number;
  footYPx: number;
  barTopPx: number;
  barBottomPx: number;
  isBarCut: { top: boolean; bottom: boolean }; // it goes on beyond the drawing
  name: { text: string; xPx: number; yPx: number } | null;
}

export interface DrawnFloor {
  floor: number | null; // null: of those whose floor nobody knows
  name: string;
  short: string;
  height: string;
  expected: boolean;
  topPx: number;
  bottomPx: number;
  leftPx: number;
  rightPx: number;
  marks: readonly DrawnMark[];
}

interface Rectangle {
  leftPx: number;
  rightPx: number;
  topPx: number;
  bottomPx: number;
}

export interface DrawnSection {
  heightPx: number;
  markPx: number;
  floors: readonly DrawnFloor[]; // top floor first
  stairs: readonly Rectangle[];
  groundPx: number;
  left: string; // what lies at the ends of the axis
  right: string;
}

export interface SectionInput {
  scene: Scene;
  plan: Plan | null;
  levels: readonly Level[]; // lowest first
  axis: AxisChoice;
  size: Size;
  textWidthPx(text: string): number;
}

export function drawnSection({ scene, plan, levels, axis, size, textWidthPx }: SectionInput): DrawnSection {
  const headingRad = axisHeadingRad(axis, placesOf(plan));
  const spans = floorSpans(plan, headingRad);
  const building = united([...spans.values()]);
  const members = membersOf(scene, headingRad);
  const frame = frameOf(building, members, levels, size);
  const placed = sectionMarks(members, frame, size.markPx);
  const marks = named(placed, scene, size, frame, textWidthPx);
  const on = (floor: number | null) => marks.filter((_, i) => placed[i]?.floor === floor);
  const topM = (levels.at(-1)?.heightM ?? 0) + storeyHeightM(levels);
  const floors = levels.map((level, i) =>
    drawnFloor(level, levels[i + 1]?.heightM ?? topM, spans.get(level.floor) ?? building, on(level.floor), frame),
  );
  const known = new Set(levels.map(({ floor }) => floor));
  const elsewhere = marks.filter((_, i) => !known.has(placed[i]?.floor ?? NaN));
  return {
    heightPx: Math.round(frame.heightPx),
    markPx: size.markPx,
    floors: [...floors.reverse(), ...(elsewhere.length > 0 ? [unknownFloor(elsewhere)] : [])],
    stairs: stairsOf(plan, headingRad).flatMap((one) => {
      const row = levels.findIndex(({ floor }) => floor === one.floor);
      const from = levels[row];
      if (from === undefined) return [];
      return [rectangle(one, from.heightM, levels[row + 1]?.heightM ?? topM, frame)];
    }),
    groundPx: Math.round(frame.yOf(groundHeightM(levels))),
    left: compassWord(headingRad - Math.PI),
    right: compassWord(headingRad),
  };
}

function drawnFloor(
  { floor, heightM, expected }: Level,
  ceilingM: number,
  span: Span | null,
  marks: readonly DrawnMark[],
  frame: Frame,
): DrawnFloor {
  const whole = { leftPx: Math.round(frame.leftPx), rightPx: Math.round(frame.rightPx) };
  return {
    floor,
    name: floorName(floor),
    short: shortFloor(floor),
    height: length(heightM),
    expected,
    marks,
    ...rectangle(span ?? { fromM: 0, toM: 0 }, heightM, ceilingM, frame),
    ...(span === null ? whole : {}),
  };
}

/** They stand at their heights all the same. */
function unknownFloor(marks: readonly DrawnMark[]): DrawnFloor {
  const nowhere = { topPx: 0, bottomPx: 0, leftPx: 0, rightPx: 0 };
  return { floor: null, name: floorName(null), short: "?", height: "", expected: true, marks, ...nowhere };
}

function rectangle({ fromM, toM }: Span, lowM: number, highM: number, frame: Frame): Rectangle {
  return {
    leftPx: Math.round(frame.xOf(fromM)),
    rightPx: Math.round(frame.xOf(toM)),
    topPx: Math.round(frame.yOf(highM)),
    bottomPx: Math.round(frame.yOf(lowM)),
  };
}

const NAME_MARK_PX = 28; // for which the places of names are made

/** Who stands alone is named where there is room, who is in danger, chosen or far away always. */
function named(
  placed: readonly SectionMark[],
  scene: Scene,
  size: Size,
  frame: Frame,
  textWidthPx: (text: string) => number,
): DrawnMark[] {
  const beyond = Math.max(0, (size.markPx - NAME_MARK_PX) / 2);
  const beside = placed.map(({ members }) => frame.isBeyond(members[0]?.alongM ?? 0));
  const texts = placed.map(({ members }, i) => nameOf(members, scene.nowMs, beside[i] ?? 0));
  const wanted = placed.map(({ xPx, yPx, members }, i) => ({
    mark: [xPx, yPx] as const,
    widthPx: textWidthPx(texts[i] ?? "") + 2 * beyond,
    strong: members.some(isStrong) || beside[i] !== 0,
    before: null,
  }));
  const gutter: Box = [0, 0, size.gutterPx, frame.heightPx];
  const screen = { size: [size.widthPx, frame.heightPx] as const, covered: [gutter], standing: [] };
  const names = placeNames(wanted, screen);
  return placed.map((mark, i) => {
    const at = names[i] ?? null;
    const text = texts[i] ?? "";
    const name =
      at === null || text === ""
        ? null
        : {
            text,
            xPx: Math.round(mark.xPx + at.offset[0]),
            yPx: Math.round(mark.yPx + at.offset[1] + beyond * Math.sign(at.offset[1])),
          };
    return { ...drawnMark(mark, scene.nowMs, frame), name };
  });
}

/** Beside the mark: nothing for a number of people who are well. */
function nameOf(members: readonly Member[], nowMs: number, beyond: -1 | 0 | 1): string {
  const [first] = members;
  if (first === undefined || (members.length > 1 && beyond === 0 && !members.some(isStrong))) return "";
  const more = members.length > 1 ? `+${members.length - 1}` : "";
  const old = first.old ? t("measure.old", { age: age(nowMs - first.position.t_ms) }) : "";
  const words = [planLabel(first.name) + (more === "" ? "" : ` ${more}`), old];
  const text = listed(words.filter((word) => word !== ""));
  return beyond === 0 ? text : beyond < 0 ? `◂ ${text}` : `${text} ▸`;
}

function drawnMark(mark: SectionMark, nowMs: number, frame: Frame): Omit<DrawnMark, "name"> {
  const { members } = mark;
  const worst = members[0] as Member; // they are joined in the order of their need
  const single = members.length === 1;
  const danger = members.filter(({ urgency }) => urgency === "immediate").length;
  const each = members.map((member) => ({ unitId: member.unitId, words: wordsOf(member, nowMs) }));
  return {
    key: mark.key,
    letters: single ? letters(worst) : `${danger > 0 ? "!" : ""}${members.length}`,
    words: single
      ? (each[0]?.words ?? "")
      : t("section.several", { count: members.length, names: listed(members.map(({ name }) => name)) }),
    urgency: worst.urgency,
    chosen: members.some(({ chosen }) => chosen),
    old: members.every(({ old }) => old),
    members: each,
    xPx: Math.round(mark.xPx),
    yPx: Math.round(mark.yPx),
    footXPx: Math.round(mark.footXPx),
    footYPx: Math.round(mark.footYPx),
    barTopPx: Math.round(mark.barTopPx),
    barBottomPx: Math.round(mark.barBottomPx),
    isBarCut: { top: mark.barTopPx <= frame.topPx, bottom: mark.barBottomPx >= frame.bottomPx },
  };
}

function letters(member: Member): string {
  const text = lettersOf(member);
  return member.floor === null && !text.includes("?") ? `${text}?` : text;
}

/** Whose mark it is, and what the drawing shows of them. */
function wordsOf(member: Member, nowMs: number): string {
  const words = [
    member.name,
    member.urgency === "immediate" ? t("section.in_danger") : "",
    floorOf(member.position, member.old),
    t("section.height", { height: length(member.heightM), error: plusMinus(member.errorM) }),
    member.old ? t("measure.old", { age: age(nowMs - member.position.t_ms) }) : "",
  ];
  return listed(words.filter((word) => word !== ""));
}
