import { describe, expect, it } from "vitest";
import { fitMargins, isInMiddle, leastMargins } from "../src/plan/margins";

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

describe("the middle of the plan", () => {
  const isIn = (place: [number, number] | null) => isInMiddle(place, [800, 400]);

  it("is three fifths of its width and of its height", () => {
    expect([isIn([400, 200]), isIn([170, 90]), isIn([630, 310])]).toEqual([true, true, true]);
    expect([isIn([150, 200]), isIn([650, 200]), isIn([400, 70]), isIn([400, 330])]).not.toContain(true);
  });

  it("is not known before the plan is drawn", () => {
    expect(isIn(null)).toBe(false);
    expect(isInMiddle([0, 0], [])).toBe(false);
    expect(isInMiddle([0, 0], [0, 0])).toBe(false);
  });
});
