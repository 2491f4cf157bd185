import { describe, expect, it } from "vitest";
import type { Colours } from "../src/plan/colours";
import { filling, MOST_ALONE, parted, turnsLeft, type DrawnRegion } from "../src/plan/regions";
import type { Mark } from "../src/plan/marks";

const COLOURS = { quiet: "#777777", immediate: "#ff0000", soon: "#ffaa00" } as Colours;

function region(change: Partial<Mark>): DrawnRegion {
  const looks = { old: true, chosen: false, urgency: "soon", ...change } as Mark;
  return { looks, border: [[0, 0], [0, 1], [1, 1], [0, 0]] };
}

function many(count: number, change: Partial<Mark>): DrawnRegion[] {
  return Array.from({ length: count }, () => region(change));
}

describe("the region of a position", () => {
  it("is the fainter the larger it is, so that it does not hide the plan", () => {
    expect(filling({ old: false }, 1)).toBe(filling({ old: false }, 3));
    expect(filling({ old: true }, 36)).toBeGreaterThan(0.15); // all of a house, by its walls
    expect(filling({ old: true }, 250)).toBeLessThan(0.03);
  });
});

describe("old regions", () => {
  it("are drawn alone while they are few", () => {
    const { alone, crowds } = parted(many(MOST_ALONE, {}), COLOURS);
    expect(alone).toHaveLength(MOST_ALONE);
    expect(crowds.size).toBe(0);
  });

  it("of a crowd are one by colour; who is chosen stays apart, and so do the few in danger", () => {
    const danger = many(2, { urgency: "immediate" });
    const fresh = many(20, { old: false });
    const chosen = region({ chosen: true });
    const { alone, crowds } = parted([...many(200, {}), ...danger, ...fresh, chosen], COLOURS);
    expect(alone).toEqual([...danger, ...fresh, chosen]);
    expect([...crowds].map(([colour, borders]) => [colour, borders.length])).toEqual([
      [COLOURS.quiet, 200],
    ]);
  });

  it("are none where nobody is looked for", () => {
    const { alone, crowds } = parted([{ ...region({}), border: [] }], COLOURS);
    expect([alone, crowds.size]).toEqual([[], 0]);
  });

  it("know which way round a border goes", () => {
    const { border } = region({});
    expect(turnsLeft(border)).not.toBe(turnsLeft([...border].reverse()));
  });
});
