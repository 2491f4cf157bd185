import { describe, expect, it } from "vitest";
import { levelsOf } from "../src/section/levels";
import { cornersOf, stackedBuilding, type Place3 } from "../src/stack/building";
import { drawnStack } from "../src/stack/drawing";
import { stackedRoute, stackedTrails } from "../src/stack/paths";
import type { Plan, TrailPoint, UnitView } from "../src/wire";
import { alarm, position, unit } from "./fixtures";

const STOREY_M = 3;
const SQUARE: [number, number][] = [[0, 0], [10, 0], [10, 8], [0, 8], [0, 0]];

function plan(features: Plan["features"]): Plan {
  const floors = [0, 1, 2].map((floor) => ({ floor, down_m: -STOREY_M * floor }));
  return { type: "FeatureCollection", muster: { frame: "site-m", floors }, features };
}

function area(kind: string, floor: number): Plan["features"][number] {
  const geometry = { type: "Polygon" as const, coordinates: [SQUARE] };
  return { type: "Feature", properties: { kind, floor }, geometry };
}

const PLAN = plan([
  area("outline", 0),
  area("stairs", 0),
  area("room", 1),
  area("stairs", 2), // nothing is above them
  {
    type: "Feature",
    properties: { kind: "door", floor: 0 },
    geometry: { type: "LineString", coordinates: [[2, 0], [3, 0]] },
  },
]);
const LEVELS = levelsOf(PLAN, [], []);

describe("a stacked building", () => {
  it("has each floor's shapes at its height", () => {
    const { floors } = stackedBuilding(PLAN, LEVELS, []);
    expect(floors.map(({ heightM }) => heightM)).toEqual([0, 3, 6]);
    expect(floors.map(({ slabs }) => slabs.length)).toEqual([1, 1, 1]);
    expect(floors[0]?.doors).toHaveLength(1);
    expect(floors[0]?.lines).toHaveLength(2);
  });

  it("leads the corners of the stairs to the next floor", () => {
    const { edges } = stackedBuilding(PLAN, LEVELS, []);
    expect(edges).toHaveLength(4);
    expect(edges.map(([from, to]) => [from[2], to[2]])).toEqual(Array(4).fill([0, 3]));
  });

  it("is as high as its top floor's ceiling", () => {
    const ups = cornersOf(stackedBuilding(PLAN, LEVELS, [])).map(([, , up]) => up);
    expect([Math.min(...ups), Math.max(...ups)]).toEqual([0, 9]);
  });

  it("holds all people where there is no plan, and is never smaller than ten metres", () => {
    const learnt = levelsOf(null, [position({ floor: 0, down_m: 0 })], []);
    const { bounds, floors } = stackedBuilding(null, learnt, [[-5, 0], [20, 1]]);
    expect(bounds.eastM).toEqual([-7, 22]);
    expect(bounds.northM[1] - bounds.northM[0]).toBeCloseTo(10);
    expect(floors[0]?.slabs).toHaveLength(1);
  });
});

const TRAIL: TrailPoint[] = [
  [0, 1, 2, null],
  [1_000, 2, 2, 0],
  [2_000, 3, 2, 1],
  [30_000, 4, 2, null, 1],
  [31_000, 5, 2, 1],
];

function trailsOf(one: UnitView, chosen: string | null, alarms = new Map()) {
  const scene = { units: [one], alarms, nowMs: 400_000, chosen };
  return stackedTrails(scene, new Map([[one.unit_id, TRAIL]]), LEVELS);
}

describe("stacked trails", () => {
  it("climb with the floors, and are broken where nothing was received", () => {
    const [first, second] = trailsOf(unit("u"), "u");
    expect(first?.places).toEqual([[2, 1, 0], [2, 2, 0], [2, 3, 3]]);
    expect(second?.places.map(([, , up]) => up)).toEqual([3, 3]);
  });

  it("are drawn of who is in danger, and of nobody else who is not chosen", () => {
    expect(trailsOf(unit("u"), null)).toEqual([]);
    const fall = alarm("a", { unit_id: "u" });
    const fallen = unit("u", { alarms: [fall.alarm_id] });
    expect(trailsOf(fallen, null, new Map([[fall.alarm_id, fall]]))).toHaveLength(2);
  });

  it("lay a route on the floors that it passes", () => {
    const places = [
      { north_m: 0, east_m: 1, floor: 0 },
      { north_m: 2, east_m: 1, floor: null },
      { north_m: 2, east_m: 1, floor: 2 },
    ];
    expect(stackedRoute({ places }, LEVELS).map(([, , up]) => up)).toEqual([0, 0, 6]);
  });
});

/** Ten pixels a metre; north is not seen. */
function pixelOf([eastM, , upM]: Place3): readonly [number, number] {
  return [100 + 10 * eastM, 200 - 10 * upM];
}

function drawn(units: readonly UnitView[]) {
  return drawnStack({
    scene: { units, alarms: new Map(), nowMs: 1_000, chosen: null },
    building: stackedBuilding(PLAN, LEVELS, []),
    widthPx: 400,
    heightPx: 300,
    markPx: 30,
    pixelOf,
    textWidthPx: (text) => 7 * text.length,
  });
}

describe("people over the stacked floors", () => {
  it("stand at their heights, listed by floor from the top", () => {
    const { floors } = drawn([unit("u", { position: position({ east_m: 4, floor: 1, down_m: -3 }) })]);
    expect(floors.map(({ short, xPx, yPx }) => [short, xPx, yPx])).toEqual([
      ["2", 100, 140],
      ["1", 100, 170],
      ["G", 100, 200],
    ]);
    const [mark] = floors[1]?.marks ?? [];
    expect([mark?.footXPx, mark?.footYPx]).toEqual([140, 170]);
  });

  it("stand at the edge where they are beyond the drawing", () => {
    const { floors } = drawn([unit("u", { position: position({ east_m: 90, floor: 0, down_m: 0 }) })]);
    const [mark] = floors[2]?.marks ?? [];
    expect(mark?.footXPx).toBe(400 - 6 - 15);
    expect(mark?.name?.text).toContain("▸");
  });

  it("are counted where there is no room for each, and none is lost", () => {
    const crowd = Array.from({ length: 300 }, (_, i) =>
      unit(`u${i}`, { position: position({ east_m: i % 10, floor: i % 3, down_m: -3 * (i % 3) }) }),
    );
    const marks = drawn(crowd).floors.flatMap((one) => one.marks);
    expect(new Set(marks.flatMap(({ members }) => members.map(({ unitId }) => unitId))).size).toBe(300);
    for (const [i, one] of marks.entries()) {
      const covering = marks.slice(0, i).filter((other) => Math.hypot(one.xPx - other.xPx, one.yPx - other.yPx) < 20);
      expect(covering).toEqual([]);
    }
  });
});
