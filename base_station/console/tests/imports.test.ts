import { describe, expect, it } from "vitest";
import { countUntil, placeAt } from "../src/plan/imports";
import type { TrailPoint } from "../src/wire";

const POINTS: readonly TrailPoint[] = [
  [1_000, 1, 2, null],
  [2_000, 3, 4, null],
  [9_000, 5, 6, 1],
];

describe("a track that was brought in", () => {
  it("has nothing of the time to come", () => {
    expect([0, 1_000, 1_999, 2_000, 10_000].map((ms) => countUntil(POINTS, ms))).toEqual([0, 1, 1, 2, 3]);
    expect(countUntil([], 5_000)).toBe(0);
  });

  it("has a place from its beginning until a minute behind its end", () => {
    expect(placeAt(POINTS, 999)).toBeNull();
    expect(placeAt(POINTS, 2_500)).toBe(POINTS[1]);
    expect(placeAt(POINTS, 69_000)).toBe(POINTS[2]);
    expect(placeAt(POINTS, 69_001)).toBeNull();
  });
});
