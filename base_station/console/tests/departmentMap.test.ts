import { expect, test } from "vitest";
import { mapOf } from "../src/department/mapScale";

const at = (lat_deg: number, lon_deg: number) => ({ lat_deg, lon_deg });

test("stations are where they are, north up, in true proportions", () => {
  const { placed, bar, barM } = mapOf([at(60, 10), at(60, 10.02), at(60.01, 10)]);
  const [middle, east, north] = placed;
  // At 60° a degree of longitude is half as long: both are 1113 m away.  The map is twice as wide as high.
  const eastward = (east?.left ?? 0) - (middle?.left ?? 0);
  const northward = (middle?.top ?? 0) - (north?.top ?? 0);
  expect(eastward).toBeCloseTo(northward / 2, 3);
  expect(east?.top).toBeCloseTo(middle?.top ?? 0, 6);
  expect(eastward / bar).toBeCloseTo(1113.2 / barM, 2);
  for (const one of placed) {
    expect(Math.min(one.left, one.top)).toBeGreaterThan(0);
    expect(Math.max(one.left, one.top)).toBeLessThan(1);
  }
});

test("one station is in the middle, also beside the date line", () => {
  expect(mapOf([at(-17, 179.99)]).placed[0]).toMatchObject({ left: 0.5, top: 0.5 });
  const across = mapOf([at(-17, 179.99), at(-17, -179.99)]).placed;
  expect((across[1]?.left ?? 0) - (across[0]?.left ?? 0)).toBeCloseTo(0.76, 2);
});
