/** From metres of the building to pixels of a side section.  Pure. */
import { united, type Span } from "./axis";
import { storeyHeightM, type Level } from "./levels";
import { BAR_PX, type Sheet, type Step } from "./marks";
import type { Member } from "./members";

export interface Size {
  widthPx: number;
  heightPx: number;
  markPx: number; // of one person
  gutterPx: number; // on the left, for the names of floors
}

/** Pixels from the upper left corner, higher than the window where floors would be too low; who is beyond
 * what is drawn stands at its edge. */
export interface Frame extends Sheet {
  topPx: number; // the highest that is drawn
  bottomPx: number;
  xOf(alongM: number): number;
  yOf(heightM: number): number;
}

/** The nearest first; the second ones where a storey has room for two rows. */
const BESIDE: readonly Step[] = [[0, 0], [1, 0], [-1, 0], [2, 0], [-2, 0]];
const ABOVE: readonly Step[] = [[0, -1], [1, -1], [-1, -1], [2, -1], [-2, -1]];

const EDGE_PX = 10;
const BAND_ROOM_PX = 10; // above and below a mark in its band
const LEAST_BESIDE_M = 6;
const LEAST_LENGTH_M = 10;
const OUTLIERS_STOREYS = 1.5; // beyond the floors, as far as heights are drawn

/** People far from the building do not make it small. */
export function frameOf(
  building: Span | null,
  members: readonly Member[],
  levels: readonly Level[],
  size: Size,
): Frame {
  const span = shownSpan(building, members);
  const storeyM = storeyHeightM(levels);
  const heights = shownHeights(levels, members, storeyM);
  const usablePx = size.heightPx - 2 * EDGE_PX - size.markPx;
  const leastPx = (size.markPx + BAND_ROOM_PX) / lowestStoreyM(levels, storeyM);
  const pxPerM = Math.max(leastPx, usablePx / (heights.toM - heights.fromM));
  const heightPx = Math.max(size.heightPx, pxPerM * (heights.toM - heights.fromM) + 2 * EDGE_PX + size.markPx);
  const half = size.markPx / 2;
  const leftPx = size.gutterPx + half;
  const rightPx = size.widthPx - EDGE_PX - half;
  const bottomPx = heightPx - EDGE_PX;
  const xScale = (rightPx - leftPx) / (span.toM - span.fromM);
  const storeyPx = pxPerM * lowestStoreyM(levels, storeyM);
  const xOf = (alongM: number) => clamp(leftPx + (alongM - span.fromM) * xScale, leftPx, rightPx);
  const yOf = (heightM: number) =>
    clamp(bottomPx - (heightM - heights.fromM) * pxPerM, EDGE_PX + size.markPx, bottomPx);
  return {
    widthPx: size.widthPx,
    heightPx,
    leftPx,
    rightPx,
    topPx: EDGE_PX + size.markPx,
    bottomPx,
    aside: storeyPx >= 2 * size.markPx + BAR_PX ? [...BESIDE, ...ABOVE] : BESIDE,
    xOf,
    yOf,
    placeOf: ({ alongM, heightM, errorM }) => ({
      footXPx: xOf(alongM),
      footYPx: yOf(heightM),
      barTopPx: yOf(heightM + errorM),
      barBottomPx: yOf(heightM - errorM),
      beyond: alongM < span.fromM - 0.5 ? -1 : alongM > span.toM + 0.5 ? 1 : 0,
    }),
  };
}

function shownSpan(building: Span | null, members: readonly Member[]): Span {
  const all = united([building, ...members.map(({ alongM }) => ({ fromM: alongM, toM: alongM }))]);
  if (all === null) return { fromM: -LEAST_LENGTH_M / 2, toM: LEAST_LENGTH_M / 2 };
  const lengthM = building === null ? 0 : building.toM - building.fromM;
  const besideM = Math.max(LEAST_BESIDE_M, lengthM / 3);
  const span =
    building === null
      ? { fromM: all.fromM - 1, toM: all.toM + 1 }
      : {
          fromM: Math.max(all.fromM, building.fromM - besideM),
          toM: Math.min(all.toM, building.toM + besideM),
        };
  const missingM = Math.max(0, LEAST_LENGTH_M - (span.toM - span.fromM));
  return { fromM: span.fromM - missingM / 2, toM: span.toM + missingM / 2 };
}

/** All floors with the top one's storey, ground for the bars below, and people near to them. */
function shownHeights(levels: readonly Level[], members: readonly Member[], storeyM: number): Span {
  const lowM = (levels[0]?.heightM ?? 0) - storeyM / 2;
  const highM = (levels.at(-1)?.heightM ?? 0) + storeyM;
  const beyondM = OUTLIERS_STOREYS * storeyM;
  const heights = members.map(({ heightM }) => clamp(heightM, lowM - beyondM, highM + beyondM));
  return { fromM: Math.min(lowM, ...heights), toM: Math.max(highM, ...heights) };
}

function lowestStoreyM(levels: readonly Level[], storeyM: number): number {
  return Math.min(storeyM, ...levels.slice(1).map(({ heightM }, i) => heightM - (levels[i]?.heightM ?? 0)));
}

function clamp(value: number, least: number, most: number): number {
  return Math.min(Math.max(value, least), most);
}
