import { describe, expect, it } from "vitest";
import type { Colours } from "../src/plan/colours";
import { shownPeople, type Scene } from "../src/plan/peopleScene";
import type { TrailPoint } from "../src/wire";
import { alarm, position, unit } from "./fixtures";

const SCENE: Scene = {
  units: [],
  alarms: new Map([["x", alarm("x", { unit_id: "down", priority: 1 })]]),
  trails: new Map(),
  nowMs: 2_000,
  silentMs: 0,
  floor: 0,
  chosen: null,
  colours: {} as Colours,
  screen: { size: [500, 500], covered: [], standing: [], pixelOf: () => null },
};

const idsOf = (change: Partial<Scene>) => shownPeople({ ...SCENE, ...change }).map(({ unitId }) => unitId);
const on = (floor: number | null) => ({ position: position({ floor }) });

describe("who is drawn on the plan", () => {
  it("is on its floor, or nobody knows where, or is in danger or chosen", () => {
    const units = [
      unit("here", on(0)),
      unit("above", on(1)),
      unit("somewhere", on(null)),
      unit("down", { ...on(1), alarms: ["x"] }),
      unit("nowhere", { position: null }),
    ];
    expect(idsOf({ units })).toEqual(["here", "somewhere", "down"]);
    expect(idsOf({ units, chosen: "above" })).toEqual(["here", "above", "somewhere", "down"]);
    expect(idsOf({ units, floor: "all" })).toEqual(["here", "above", "somewhere", "down"]);
  });

  it("costs nobody else the place where one cannot be drawn", () => {
    const odd = unit("odd", { position: { ...position({ floor: 0 }), reach: null as never } });
    expect(idsOf({ units: [odd, unit("here", on(0))] })).toEqual(["here"]);
  });

  it("has a trail; in a crowd only who is in danger or chosen has", () => {
    const trail: TrailPoint[] = [[1_000, 0, 0, 0], [2_000, 1, 0, 0]];
    const few = [unit("a", on(0)), unit("down", { ...on(0), alarms: ["x"] })];
    const many = [...few, ...Array.from({ length: 20 }, (_, i) => unit(`u${i}`, on(0)))];
    const withTrail = (units: typeof few) => {
      const trails = new Map(units.map(({ unit_id }) => [unit_id, trail]));
      return shownPeople({ ...SCENE, units, trails }).filter((one) => one.trail.length > 0).map(({ unitId }) => unitId);
    };
    expect(withTrail(few)).toEqual(["a", "down"]);
    expect(withTrail(many)).toEqual(["down"]);
  });
});
