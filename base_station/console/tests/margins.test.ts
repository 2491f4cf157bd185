import { describe, expect, it } from "vitest";
import { fitMargins, leastMargins } from "../src/plan/margins";

describe("margins about people on the plan", () => {
  it("leave room for the zoom buttons and names where the plan is large", () => {
    expect(fitMargins([600, 500])).toEqual([40, 70, 60, 40]);
  });

  it.each([
    [600, 500],
    [300, 100],
    [150, 400],
    [40, 40],
  ])("leave most of a plan of %i by %i to people, and a fit keeps to the least of them", (w, h) => {
    const [top, right, bottom, left] = fitMargins([w, h]);
    expect(left + right).toBeLessThan(w / 2);
    expect(top + bottom).toBeLessThan(h / 2);
    leastMargins([w, h]).forEach((px, side) => {
      expect(px).toBeLessThan(fitMargins([w, h])[side] ?? 0);
    });
  });
});
