/** A side section as it is drawn: texts, and whole pixels, so that what did not change is not drawn again.
 * Pure. */
import { floorName, shortFloor } from "../format";
import { length } from "../language/measures";
import { compassWord } from "../plan/edges";
import type { Plan } from "../wire";
import { axisHeadingRad, floorSpans, placesOf, stairsOf, united, type AxisChoice, type Span } from "./axis";
import { frameOf, type Frame, type Size } from "./frame";
import { groundHeightM, storeyHeightM, type Level } from "./levels";
import { drawnMarks, type DrawnMark } from "./markDrawing";
import { sectionMarks } from "./marks";
import { membersOf, type Scene } from "./members";

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
  const marks = drawnMarks(placed, {
    sheet: frame,
    markPx: size.markPx,
    topPx: frame.topPx,
    bottomPx: frame.bottomPx,
    covered: [[0, 0, size.gutterPx, frame.heightPx]],
    nowMs: scene.nowMs,
    textWidthPx,
  });
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

/** Drawn at their heights all the same. */
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
