import { describe, expect, it } from "vitest";
import { contents } from "../src/plan/contents";
import type { Plan } from "../src/wire";

const room = { type: "Feature", properties: { kind: "room" }, geometry: null };

describe("what a plan holds", () => {
  it("is its name, and what it has of everything", () => {
    const plan = {
      type: "FeatureCollection",
      muster: { frame: "site-m", name: "Yard", floors: [{ floor: 0, down_m: 0 }] },
      features: [room, room, { ...room, properties: null }],
    } as unknown as Plan;
    expect(contents(plan)).toBe("Yard: 1 floor, 2 rooms, 3 shapes");
  });

  it("is said of any file, be it a plan or not", () => {
    const nothing = "unnamed plan: 0 floors, 0 rooms, 0 shapes";
    for (const file of ["{}", "[]", '{"features": 3, "muster": 4}', '{"muster": {"floors": {}}}'])
      expect(contents(JSON.parse(file))).toBe(nothing);
    expect(contents({ features: [null] } as unknown as Plan)).toContain("1 shape");
  });
});
