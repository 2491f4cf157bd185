import { expect, it } from "vitest";
import { outline, regionAt, ring } from "../src/plan/ellipse";
import { position } from "./fixtures";

const CENTRE = [100, 200] as const;

/** How far each point of a ring lies along a heading and across it. */
function alongAndAcross(points: readonly [number, number][], heading_rad: number) {
  const [sin, cos] = [Math.sin(heading_rad), Math.cos(heading_rad)];
  return points.map(([east, north]) => {
    const [e, n] = [east - CENTRE[0], north - CENTRE[1]];
    return [e * sin + n * cos, e * cos - n * sin] as const;
  });
}

it.each([0, 0.6, 1.5, 2.5, -0.8])("the longer axis lies along its heading (%f rad)", (turn) => {
  const points = ring(CENTRE, { major_m: 10, minor_m: 2, heading_rad: turn });
  const seen = alongAndAcross(points, turn);
  for (const [along, across] of seen) {
    expect((along / 10) ** 2 + (across / 2) ** 2).toBeCloseTo(1, 9);
  }
  expect(Math.max(...seen.map(([along]) => along))).toBeCloseTo(10, 9);
  expect(Math.max(...seen.map(([, across]) => across))).toBeCloseTo(2, 9);
  expect(points[0]).toEqual(points.at(-1));
});

it("while the station is silent somebody walks on, but not for ever", () => {
  const last = position({
    ellipse_major_m: 3,
    ellipse_minor_m: 1,
    ellipse_heading_rad: 0.5,
    reach: [[1, 1]],
  });
  expect(regionAt(last, 20_000)).toEqual({ major_m: 23, minor_m: 21, heading_rad: 0.5 });
  expect(regionAt(last, 400_000).major_m).toBe(253);
  expect(outline(CENTRE, last, 0)).toEqual([[1, 1], [1, 1]]);
  expect(outline(CENTRE, last, 1000)).toEqual(ring(CENTRE, regionAt(last, 1000)));
});
