/** People and names of floors over the drawing in three dimensions: whole pixels, so that what did not change
 * is not drawn again.  Pure. */
import { floorName, shortFloor } from "../format";
import { length } from "../language/measures";
import { drawnMarks, type DrawnMark } from "../section/markDrawing";
import { sectionMarks, type Place, type Sheet, type Step } from "../section/marks";
import { membersOf, type Member, type Scene } from "../section/members";
import type { Place3, StackedBuilding, StackedFloor } from "./building";

export interface StackedLabel {
  floor: number | null; // null: of those whose floor nobody knows
  name: string;
  short: string;
  height: string;
  xPx: number; // beside the left corner of the floor
  yPx: number;
  marks: readonly DrawnMark[];
}

export interface DrawnStack {
  markPx: number;
  floors: readonly StackedLabel[]; // top floor first
}

export interface StackInput {
  scene: Scene;
  building: StackedBuilding;
  widthPx: number;
  heightPx: number;
  markPx: number;
  pixelOf(place: Place3): readonly [number, number];
  textWidthPx(text: string): number;
}

const EDGE_PX = 6;
const STEPS = [0, 1, 2, 3, 4].flatMap((step) => (step === 0 ? [0] : [step, -step]));
/** A mark may stand aside in any direction: a line leads to its place. */
const AROUND = STEPS.flatMap((right) => STEPS.map((down): Step => [right, down])).sort(
  (a, b) => Math.hypot(...a) - Math.hypot(...b),
);

export function drawnStack(input: StackInput): DrawnStack {
  const { scene, building, heightPx, markPx, textWidthPx } = input;
  const sheet = sheetOf(input);
  const placed = sectionMarks(membersOf(scene, 0), sheet, markPx);
  const marks = drawnMarks(placed, {
    sheet,
    markPx,
    topPx: EDGE_PX,
    bottomPx: heightPx - EDGE_PX,
    covered: [],
    nowMs: scene.nowMs,
    textWidthPx,
  });
  const on = (floor: number | null) => marks.filter((_, i) => placed[i]?.floor === floor);
  const floors = building.floors.map((one) => ({
    floor: one.floor,
    name: floorName(one.floor),
    short: shortFloor(one.floor),
    height: length(one.heightM),
    ...leftCornerPx(one, input),
    marks: on(one.floor),
  }));
  const known = new Set(building.floors.map(({ floor }) => floor));
  const elsewhere = marks.filter((_, i) => !known.has(placed[i]?.floor ?? NaN));
  return { markPx, floors: [...floors.reverse(), ...(elsewhere.length > 0 ? [floorUnknown(elsewhere)] : [])] };
}

/** Drawn at their heights all the same. */
function floorUnknown(marks: readonly DrawnMark[]): StackedLabel {
  return { floor: null, name: floorName(null), short: "?", height: "", xPx: 0, yPx: 0, marks };
}

function leftCornerPx({ slabs, heightM }: StackedFloor, { widthPx, heightPx, pixelOf }: StackInput) {
  const border = slabs.flatMap(([ring]) => ring ?? []);
  const corners = border.map(([east = 0, north = 0]) => pixelOf([east, north, heightM]));
  const [x, y] = corners.reduce((left, one) => (one[0] < left[0] ? one : left), [widthPx, 0] as const);
  return { xPx: Math.round(clamp(x, 0, widthPx)), yPx: Math.round(clamp(y, 0, heightPx)) };
}

/** People outside the drawing are drawn at its edge. */
function sheetOf({ widthPx, heightPx, markPx, pixelOf }: StackInput): Sheet {
  const [leftPx, rightPx] = [EDGE_PX + markPx / 2, widthPx - EDGE_PX - markPx / 2];
  const x = (px: number) => clamp(px, leftPx, rightPx);
  const y = (px: number) => clamp(px, EDGE_PX + markPx, heightPx - EDGE_PX);
  const placeOf = ({ position, heightM, errorM }: Member): Place => {
    const at = (upM: number) => pixelOf([position.east_m, position.north_m, upM]);
    const [footX, footY] = at(heightM);
    return {
      footXPx: x(footX),
      footYPx: y(footY),
      barTopPx: y(at(heightM + errorM)[1]),
      barBottomPx: y(at(heightM - errorM)[1]),
      beyond: footX < leftPx ? -1 : footX > rightPx ? 1 : 0,
    };
  };
  return { widthPx, heightPx, leftPx, rightPx, aside: AROUND, placeOf };
}

function clamp(value: number, least: number, most: number): number {
  return Math.min(Math.max(value, least), most);
}
