import { describe, expect, it } from "vitest";
import { compassWord, edgeMarks, type Outside } from "../src/plan/edges";
import type { Pixel } from "../src/plan/names";

const SIZE: Pixel = [400, 300];

function outside(unitId: string, mark: Pixel): Outside {
  return { unitId, name: unitId, initials: unitId, mark };
}

function placesOf(marks: readonly Pixel[]): Pixel[] {
  const people = marks.map((mark, i) => outside(String(i), mark));
  return edgeMarks(people, SIZE, []).map(({ at }) => at);
}

describe("the plan's edge", () => {
  it("points to nobody who is in the view", () => {
    expect(placesOf([[200, 150], [7, 7], [393, 293]])).toEqual([]);
  });

  it("points straight to each side", () => {
    expect(placesOf([[200, -900], [900, 150], [200, 900], [-900, 150]])).toEqual([
      [200, 28],
      [372, 150],
      [200, 272],
      [28, 150],
    ]);
  });

  it("points over the corner to who is beyond it", () => {
    const [place] = edgeMarks([outside("a", [200 + 344, 150 - 244])], SIZE, []);
    expect(place?.at[0]).toBeCloseTo(372);
    expect(place?.at[1]).toBeCloseTo(28);
    expect(compassWord(place?.bearingRad ?? 0)).toBe("north-east");
  });

  it("keeps the marks of many apart, and clear of what covers the plan", () => {
    const people = Array.from({ length: 12 }, (_, i) => outside(`u${i}`, [200 + i, -500]));
    const covered = [[180, 0, 220, 60]] as const;
    const places = edgeMarks(people, SIZE, covered).map(({ at }) => at);
    places.forEach(([x, y], i) => {
      expect(x + 20 <= 180 || x - 20 >= 220 || y - 20 >= 60).toBe(true);
      places.slice(i + 1).forEach(([otherX, otherY]) => {
        expect(Math.max(Math.abs(x - otherX), Math.abs(y - otherY))).toBeGreaterThanOrEqual(40);
      });
    });
  });

  it("points even where there is no room for all", () => {
    const people = Array.from({ length: 60 }, (_, i) => outside(`u${i}`, [900, 150]));
    expect(edgeMarks(people, SIZE, [])).toHaveLength(60);
    expect(edgeMarks(people, [0, 0], [])).toEqual([]);
  });

  it("names the quarter", () => {
    expect([0, Math.PI / 2, Math.PI, -Math.PI / 2, -3].map(compassWord)).toEqual([
      "north",
      "east",
      "south",
      "west",
      "south",
    ]);
  });
});
