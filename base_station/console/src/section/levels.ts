/** Floors of a side section with their heights, of the plan or as the station has learnt them.  Pure. */
import type { Plan, PositionView } from "../wire";

export interface Level {
  floor: number;
  heightM: number; // above the origin of the site
  expected: boolean; // between two known floors: nobody has been there, and no plan has it
}

const STOREY_M = 3; // where a single floor is known

/** Lowest first.  The plan's floors are all there are; without them a floor that was learnt stays when it
 * is left (`before`). */
export function levelsOf(
  plan: Plan | null,
  positions: readonly PositionView[],
  before: readonly Level[],
): Level[] {
  const planned = plan?.muster.floors ?? [];
  if (planned.length > 0) return rising(new Map(planned.map(({ floor, down_m }) => [floor, 0 - down_m])));
  const known = new Map(before.filter(({ expected }) => !expected).map(({ floor, heightM }) => [floor, heightM]));
  for (const [floor, heightsM] of learnt(positions)) known.set(floor, median(heightsM));
  return withExpected(rising(known));
}

/** Heights of floors, one for each person on it. */
function learnt(positions: readonly PositionView[]): Map<number, number[]> {
  const heightsM = new Map<number, number[]>();
  for (const { floor, floor_down_m, down_m } of positions) {
    if (floor === null) continue;
    const heightM = 0 - (floor_down_m ?? down_m);
    heightsM.set(floor, [...(heightsM.get(floor) ?? []), heightM]);
  }
  return heightsM;
}

function median(values: readonly number[]): number {
  return [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)] ?? 0;
}

/** A floor that is not above the one below it is of another building: one section cannot show both. */
function rising(heightsM: ReadonlyMap<number, number>): Level[] {
  const levels: Level[] = [];
  for (const [floor, heightM] of [...heightsM].sort(([a], [b]) => a - b)) {
    if (heightM > (levels.at(-1)?.heightM ?? -Infinity)) levels.push({ floor, heightM, expected: false });
  }
  return levels;
}

function withExpected(levels: readonly Level[]): Level[] {
  return levels.flatMap((level, i) => {
    const above = levels[i + 1];
    if (above === undefined) return [level];
    const count = above.floor - level.floor;
    const stepM = (above.heightM - level.heightM) / count;
    const between = Array.from({ length: count - 1 }, (_, k) => ({
      floor: level.floor + k + 1,
      heightM: level.heightM + (k + 1) * stepM,
      expected: true,
    }));
    return [level, ...between];
  });
}

/** Between two floors; the top one is as high as the others are mostly. */
export function storeyHeightM(levels: readonly Level[]): number {
  const stepsM = levels.slice(1).map(({ heightM }, i) => heightM - (levels[i]?.heightM ?? 0));
  return stepsM.length === 0 ? STOREY_M : median(stepsM);
}

/** Height of the ground outside: that of the ground floor, or else of the starts of paths. */
export function groundHeightM(levels: readonly Level[]): number {
  return levels.find(({ floor }) => floor === 0)?.heightM ?? 0;
}
