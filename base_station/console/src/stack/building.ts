/** The floors of a plan above each other, for a drawing in three dimensions.  Pure. */
import type { Polygon } from "geojson";
import { placesOf } from "../section/axis";
import { storeyHeightM, type Level } from "../section/levels";
import type { Plan } from "../wire";

/** Metres to the east and north. */
export type Corner = readonly number[];
/** Metres to the east, north and up. */
export type Place3 = readonly [eastM: number, northM: number, upM: number];

export interface StackedFloor {
  floor: number;
  heightM: number;
  slabs: readonly Corner[][][]; // polygons: an outer ring and its holes
  stairs: readonly Corner[][][];
  lines: readonly Corner[][]; // walls and the borders of rooms
  doors: readonly Corner[][];
  expected: boolean; // no plan has it and nobody has been there
}

export interface StackedBuilding {
  floors: readonly StackedFloor[]; // lowest first
  edges: readonly (readonly [Place3, Place3])[]; // of the stairs, from each floor to the next
  bounds: Bounds;
}

export interface Bounds {
  eastM: readonly [from: number, to: number];
  northM: readonly [from: number, to: number];
  upM: readonly [from: number, to: number];
}

const BESIDE_M = 2; // about the people, where no plan says how large the building is
const LEAST_SIDE_M = 10;

/** `people`: places that the drawing holds where there is no plan. */
export function stackedBuilding(
  plan: Plan | null,
  levels: readonly Level[],
  people: readonly Corner[],
): StackedBuilding {
  const planned = placesOf(plan);
  const side = (axis: 0 | 1) =>
    planned.length > 0 ? sideOf(planned, axis, 0, 0) : sideOf(people, axis, BESIDE_M, LEAST_SIDE_M);
  const [eastM, northM] = [side(0), side(1)] as const;
  const ground = rectangle(eastM, northM);
  const floors = levels.map((level) => stackedFloor(plan, level, ground));
  const low = levels[0]?.heightM ?? 0;
  const high = (levels.at(-1)?.heightM ?? 0) + storeyHeightM(levels);
  return {
    floors,
    edges: floors.flatMap((one, i) => stairEdges(one, floors[i + 1])),
    bounds: { eastM, northM, upM: [low, high] },
  };
}

/** All that the floors' borders reach, at the ground of each and at the top. */
export function cornersOf({ floors, bounds }: StackedBuilding): Place3[] {
  return floors.flatMap(({ slabs, heightM }, i) => {
    const topM = floors[i + 1]?.heightM ?? bounds.upM[1];
    const border = slabs.flatMap(([ring]) => ring ?? []);
    return border.flatMap(([east = 0, north = 0]): Place3[] => [
      [east, north, heightM],
      [east, north, topM],
    ]);
  });
}

function stackedFloor(plan: Plan | null, { floor, heightM, expected }: Level, ground: Corner[]): StackedFloor {
  const shapes = (plan?.features ?? []).filter(({ properties }) => properties?.["floor"] === floor);
  const of = (kind: string) => shapes.filter(({ properties }) => properties?.["kind"] === kind);
  const areas = (kind: string) => of(kind).flatMap(({ geometry }) => polygons(geometry));
  const doors = of("door").flatMap(({ geometry }) => linesOf(geometry));
  const slabs = [areas("outline"), areas("room"), [[ground]]].find((some) => some.length > 0) ?? [];
  const lines = shapes
    .filter(({ properties }) => properties?.["kind"] !== "door")
    .flatMap(({ geometry }) => linesOf(geometry));
  return {
    floor,
    heightM,
    slabs,
    stairs: areas("stairs"),
    lines: lines.length > 0 ? lines : [[...ground, ...ground.slice(0, 1)]],
    doors,
    expected,
  };
}

type Geometry = Plan["features"][number]["geometry"];

function polygons(geometry: Geometry): Polygon["coordinates"][] {
  if (geometry?.type === "Polygon") return [geometry.coordinates];
  return geometry?.type === "MultiPolygon" ? geometry.coordinates : [];
}

function linesOf(geometry: Geometry): Corner[][] {
  if (geometry?.type === "LineString") return [geometry.coordinates];
  if (geometry?.type === "MultiLineString") return geometry.coordinates;
  return polygons(geometry).flat();
}

/** Upright, at the corners of the stairs; none where no floor is above them. */
function stairEdges({ stairs, heightM }: StackedFloor, above: StackedFloor | undefined): [Place3, Place3][] {
  if (above === undefined) return [];
  return stairs.flatMap(([ring]) =>
    (ring ?? []).slice(1).map(([east = 0, north = 0]): [Place3, Place3] => [
      [east, north, heightM],
      [east, north, above.heightM],
    ]),
  );
}

/** From the least to the greatest coordinate on an axis, 0 for east and 1 for north, with room beside. */
function sideOf(places: readonly Corner[], axis: 0 | 1, besideM: number, leastM: number): [number, number] {
  let [from, to] = [Infinity, -Infinity];
  for (const place of places) {
    from = Math.min(from, place[axis] ?? 0);
    to = Math.max(to, place[axis] ?? 0);
  }
  if (from > to) [from, to] = [0, 0];
  const missingM = Math.max(0, leastM - (to - from) - 2 * besideM) / 2;
  return [from - besideM - missingM, to + besideM + missingM];
}

function rectangle([west, east]: readonly [number, number], [south, north]: readonly [number, number]): Corner[] {
  return [
    [west, south],
    [east, south],
    [east, north],
    [west, north],
  ];
}
