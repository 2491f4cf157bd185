import { describe, expect, it } from "vitest";
import { axisHeadingRad, floorSpans, stairsOf } from "../src/section/axis";
import { drawnSection, type SectionInput } from "../src/section/drawing";
import { levelsOf, storeyHeightM } from "../src/section/levels";
import type { Plan, PositionView, UnitView } from "../src/wire";
import { alarm, position, unit } from "./fixtures";

const STOREY_M = 3;

/** 20 m to the north-east and 5 m across it, of three floors. */
function turnedPlan(): Plan {
  const along = (m: number, across: number): [number, number] => [
    (m + across) / Math.SQRT2,
    (m - across) / Math.SQRT2,
  ];
  const area = (kind: string, floor: number, from: number, to: number): Plan["features"][number] => ({
    type: "Feature",
    properties: { kind, floor },
    geometry: { type: "Polygon", coordinates: [[along(from, 0), along(to, 0), along(to, 5), along(from, 5)]] },
  });
  return {
    type: "FeatureCollection",
    muster: { frame: "site-m", floors: [0, 1, 2].map((floor) => ({ floor, down_m: -STOREY_M * floor })) },
    features: [area("outline", 0, 0, 20), area("stairs", 0, 2, 4), area("outline", 1, 0, 12)],
  };
}

function at(east_m: number, floor: number, change: Partial<PositionView> = {}): PositionView {
  return position({ east_m, floor, down_m: -STOREY_M * floor, ...change });
}

function drawn(units: readonly UnitView[], change: Partial<SectionInput> = {}) {
  const plan = change.plan === undefined ? turnedPlan() : change.plan;
  const positions = units.flatMap((one) => (one.position ? [one.position] : []));
  return drawnSection({
    scene: { units, alarms: new Map(), nowMs: 1_000, chosen: null },
    plan,
    levels: levelsOf(plan, positions, []),
    axis: "east",
    size: { widthPx: 800, heightPx: 400, markPx: 30, gutterPx: 100 },
    textWidthPx: (text) => 7 * text.length,
    ...change,
  });
}

function floorNamed(section: ReturnType<typeof drawn>, name: string) {
  const found = section.floors.find((one) => one.name === name);
  if (found === undefined) throw new Error(`there is no ${name}`);
  return found;
}

describe("the axis of a side section", () => {
  it("is the longer side of a turned building, from the west to the east", () => {
    const corners = turnedPlan().features.flatMap(({ geometry }) =>
      geometry?.type === "Polygon" ? geometry.coordinates.flat() : [],
    );
    expect(axisHeadingRad("longest", corners)).toBeCloseTo(Math.PI / 4, 1);
    expect(axisHeadingRad("north", corners)).toBe(0);
    expect(axisHeadingRad("longest", [])).toBe(Math.PI / 2);
  });

  it("has each floor as long as it is, and the stairs", () => {
    const heading = Math.PI / 4;
    expect(floorSpans(turnedPlan(), heading).get(0)?.toM).toBeCloseTo(20);
    expect(floorSpans(turnedPlan(), heading).get(1)?.toM).toBeCloseTo(12);
    const [stairs] = stairsOf(turnedPlan(), heading);
    expect([stairs?.fromM, stairs?.toM].map((m) => Math.round(m ?? 0))).toEqual([2, 4]);
  });
});

describe("the floors of a side section", () => {
  it("are those of the plan, where it has any", () => {
    expect(levelsOf(turnedPlan(), [at(0, 7)], []).map(({ floor }) => floor)).toEqual([0, 1, 2]);
  });

  it("are learnt from where people are, with those that must lie between, and stay when they are left", () => {
    const learnt = [at(0, 0, { floor_down_m: 0.2 }), at(0, 2, { down_m: -5, floor_down_m: -6.2 })];
    const levels = levelsOf(null, learnt, []);
    expect(levels.map(({ floor, expected }) => [floor, expected])).toEqual([[0, false], [1, true], [2, false]]);
    expect(levels.map(({ heightM }) => heightM)).toEqual([-0.2, 3, 6.2]);
    expect(storeyHeightM(levels)).toBeCloseTo(3.2);
    expect(levelsOf(null, [], levels)).toEqual(levels);
    expect(levelsOf(null, [at(0, 1, { floor_down_m: -2.9 })], levels)[1]).toEqual({
      floor: 1,
      heightM: 2.9,
      expected: false,
    });
  });

  it("rise: what does not is of another building", () => {
    const mixed = [at(0, 0, { floor_down_m: 0 }), at(0, 1, { floor_down_m: 4 }), at(0, 2, { floor_down_m: -6 })];
    expect(levelsOf(null, mixed, []).map(({ floor, heightM }) => [floor, heightM])).toEqual([[0, 0], [1, 3], [2, 6]]);
  });
});

describe("people in a side section", () => {
  it("stand at their heights with their errors, each on their floor", () => {
    const section = drawn([
      unit("A", { position: at(5, 0, { std_down_m: 0.5 }) }),
      unit("B", { position: at(5, 2) }),
      unit("C", { position: null }),
    ]);
    const [low] = floorNamed(section, "ground floor").marks;
    const [high] = floorNamed(section, "floor 2").marks;
    expect([low?.key, high?.key]).toEqual(["A", "B"]);
    expect(low?.footYPx).toBe(floorNamed(section, "ground floor").bottomPx);
    expect(section.groundPx).toBe(low?.footYPx);
    expect(low?.barBottomPx).toBeGreaterThan(low?.footYPx ?? 0);
    expect((low?.footYPx ?? 0) - (low?.barTopPx ?? 0)).toBe((low?.barBottomPx ?? 0) - (low?.footYPx ?? 0));
    expect(high?.footYPx).toBeLessThan(low?.barTopPx ?? 0);
    expect(section.floors.flatMap(({ marks }) => marks)).toHaveLength(2);
  });

  it("have a bar without an end where it goes on beyond the drawing", () => {
    const section = drawn([
      unit("A", { position: at(5, 0, { std_down_m: 0.3 }) }),
      unit("B", { position: at(15, 2, { std_down_m: 40 }) }),
    ]);
    const cut = section.floors.flatMap(({ marks }) => marks.map(({ key, isBarCut }) => [key, isBarCut]));
    expect(Object.fromEntries(cut)).toEqual({
      A: { top: false, bottom: false },
      B: { top: true, bottom: true },
    });
  });

  it("are shown from the south where no plan says which side is longer, however they stand", () => {
    const line = [0, 20, 40].map((north_m, i) => unit(`U${i}`, { position: position({ north_m, floor: 0 }) }));
    expect(drawn(line, { plan: null, axis: "longest" }).right).toBe("east");
  });

  it("are on no floor where it is uncertain", () => {
    const section = drawn([unit("A", { position: at(5, 1, { floor_probability: 0.4 }) })]);
    const [mark] = floorNamed(section, "floor unknown").marks;
    expect(mark?.letters).toMatch(/\?$/);
    expect(floorNamed(section, "floor 1").marks).toEqual([]);
  });

  it("fold into a number where they cover each other, but whoever is in danger does not", () => {
    const units = Array.from({ length: 200 }, (_, i) => {
      const id = `U${String(i).padStart(3, "0")}`;
      return unit(id, { position: at(i % 10, i % 3), alarms: id === "U030" ? ["x"] : [] });
    });
    const section = drawn(units, {
      scene: { units, alarms: new Map([["x", alarm("x", { unit_id: "U030" })]]), nowMs: 1_000, chosen: "U040" },
    });
    const marks = section.floors.flatMap((one) => one.marks);
    expect(marks.reduce((count, { members }) => count + members.length, 0)).toBe(200);
    const own = marks.filter(({ members }) => members.length === 1).map(({ key }) => key);
    expect(own).toEqual(expect.arrayContaining(["U030", "U040"]));
    marks.forEach((one, i) => {
      for (const other of marks.slice(i + 1)) {
        const apart = [Math.abs(one.xPx - other.xPx), Math.abs(one.yPx - other.yPx)];
        expect(Math.max(...apart)).toBeGreaterThanOrEqual(29);
      }
    });
    for (const { name, marks: on } of section.floors) {
      const floors = on.flatMap(({ members }) => members.map(({ words }) => words.includes(name)));
      expect(floors.every((same) => same)).toBe(true);
    }
  });

  it("stand at the edge, named, where they are far away", () => {
    const section = drawn([unit("A", { position: at(5, 0) }), unit("B", { label: "Far", position: at(-900, 0) })]);
    const far = floorNamed(section, "ground floor").marks.find(({ key }) => key === "B");
    expect(far?.xPx).toBeGreaterThan(100);
    expect(far?.name?.text).toBe("◂ Far");
  });

  it("have at least the height of a mark on each of many floors", () => {
    const units = Array.from({ length: 30 }, (_, i) => unit(`U${i}`, { position: at(1, i) }));
    const section = drawn(units, { plan: null });
    const heights = section.floors.map(({ topPx, bottomPx }) => bottomPx - topPx);
    expect(Math.min(...heights)).toBeGreaterThanOrEqual(30);
    expect(section.heightPx).toBeGreaterThan(30 * 30);
  });
});
