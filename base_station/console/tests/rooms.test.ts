import { describe, expect, it } from "vitest";
import type { Region } from "../src/plan/ellipse";
import { roomWord } from "../src/plan/rooms";
import type { Plan, PositionView } from "../src/wire";
import { position } from "./fixtures";

/** A store about a shaft, from 0 to 10 m each way; the shaft from 4 to 6 m. */
const PLAN: Plan = {
  type: "FeatureCollection",
  muster: { frame: "site-m" },
  features: [
    {
      type: "Feature",
      properties: { kind: "room", floor: 0, name: "store" },
      geometry: { type: "Polygon", coordinates: [square(0, 10), square(4, 6)] },
    },
  ],
};

function square(from: number, to: number): number[][] {
  return [
    [from, from],
    [to, from],
    [to, to],
    [from, to],
    [from, from],
  ];
}

function word(radiusM: number, change: Partial<PositionView>): string {
  const region: Region = { major_m: radiusM, minor_m: radiusM, heading_rad: 0 };
  return roomWord(PLAN, position({ north_m: 2, east_m: 2, ...change }), region);
}

describe("the room of a position", () => {
  it("is said to be sure only where the whole region lies in it", () => {
    expect(word(1, {})).toBe("in store");
    expect(word(2.5, {})).toBe("near store");
  });

  it.each([
    ["in a shaft in its middle", 0.5, { north_m: 5, east_m: 5 }],
    ["outside", 1, { north_m: -1 }],
    ["on another floor", 1, { floor: 1 }],
    ["where the floor is not known", 1, { floor: null }],
    ["where the floor is in doubt", 1, { floor_probability: 0.7 }],
    ["where the place is hardly known", 11, {}],
  ])("is not said %s", (_, radiusM, change) => {
    expect(word(radiusM, change)).toBe("");
  });

  it.each([
    ["on the inner side of a slanted wall", 33, 23, "in loft"],
    ["on its outer side", 37, 27, ""],
    ["on its outer side, further down", 31.5, 29, ""],
    ["in the other part of the same room", 35, 53, "in loft"],
    ["between the two parts", 33, 45, ""],
  ])("is told %s", (_, north_m, east_m, said) => {
    const loft: Plan = {
      ...PLAN,
      features: [
        {
          type: "Feature",
          properties: { kind: "room", floor: 0, name: "loft" },
          geometry: {
            type: "MultiPolygon",
            coordinates: [20, 50].map((east) => [
              [
                [east, 30],
                [east + 10, 30],
                [east, 40],
                [east, 30],
              ],
            ]),
          },
        },
      ],
    };
    const region: Region = { major_m: 0.5, minor_m: 0.5, heading_rad: 0 };
    expect(roomWord(loft, position({ north_m, east_m }), region)).toBe(said);
  });

  it("is not said without a plan", () => {
    expect(roomWord(null, position(), { major_m: 1, minor_m: 1, heading_rad: 0 })).toBe("");
  });
});
