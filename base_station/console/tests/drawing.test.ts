import { expect, test } from "vitest";
import { downOf, emptyPaper, isComplete, metresPerPixel, pixelAt, siteAt, withFloor, type Scale } from "../src/plan/drawing";
import type { Plan } from "../src/wire";

const SCALE: Scale = { one: { x: 100, y: 400 }, other: { x: 300, y: 400 }, length_m: 20, east_m: 5, north_m: -3 };
const PAPER = { width_px: 1000, height_px: 500, webp: "UklGRg==" };

test("two points give metres, and up on the paper is north", () => {
  expect(metresPerPixel(SCALE)).toBe(0.1);
  expect(siteAt(SCALE, { x: 100, y: 400 })).toEqual([5, -3]);
  expect(siteAt(SCALE, { x: 100, y: 300 })).toEqual([5, 7]);
  expect(pixelAt(SCALE, siteAt(SCALE, { x: 700, y: 50 }))).toEqual({ x: 700, y: 50 });
});

test("a floor gets its picture, its height and its lines", () => {
  const lines = [
    { kind: "wall" as const, points: [{ x: 100, y: 400 }, { x: 200, y: 400 }] },
    { kind: "stairs" as const, points: [{ x: 100, y: 400 }, { x: 120, y: 400 }, { x: 120, y: 380 }] },
  ];
  const plan = withFloor(null, { floor: 1, down_m: -3.2, paper: PAPER, scale: SCALE, lines }, "Mill Road 7");
  expect(plan.muster).toEqual({
    frame: "site-m",
    name: "Mill Road 7",
    floors: [{ floor: 1, down_m: -3.2 }],
    pictures: [
      { floor: 1, webp: "UklGRg==", upper_left_m: [-5, 37], upper_right_m: [95, 37], lower_left_m: [-5, -13] },
    ],
  });
  expect(plan.features.map((one) => one.geometry)).toEqual([
    { type: "LineString", coordinates: [[5, -3], [15, -3]] },
    { type: "Polygon", coordinates: [[[5, -3], [7, -3], [7, -1], [5, -3]]] },
  ]);
});

test("another picture of a floor takes the place of the first, and all else stays", () => {
  const drawn = { floor: 0, down_m: 0, paper: PAPER, scale: SCALE, lines: [] };
  const first = withFloor(null, drawn, "House");
  const upper = withFloor(first, { ...drawn, floor: 1, down_m: -3 }, "Upper");
  const again = withFloor(upper, { ...drawn, paper: { ...PAPER, webp: "UklGRv" } }, "Again");
  expect(again.muster.name).toBe("House");
  expect(again.muster.floors).toEqual([{ floor: 0, down_m: 0 }, { floor: 1, down_m: -3 }]);
  expect(again.muster.pictures?.map(({ floor, webp }) => [floor, webp])).toEqual([[1, "UklGRg=="], [0, "UklGRv"]]);
  const byHand = withFloor(again, { ...drawn, paper: { ...PAPER, webp: null } }, "");
  expect(byHand.muster.pictures).toEqual(again.muster.pictures);
});

test("empty paper lies round the plan's lines", () => {
  const wall = { type: "LineString" as const, coordinates: [[0, 0], [40, 20]] };
  const plan: Plan = {
    type: "FeatureCollection",
    muster: { frame: "site-m", floors: [{ floor: 2, down_m: -7 }] },
    features: [{ type: "Feature", properties: { kind: "wall", floor: 2 }, geometry: wall }],
  };
  const { paper, scale } = emptyPaper(plan);
  expect(siteAt(scale, { x: 0, y: paper.height_px })).toEqual([-10, -10]);
  const [east, north] = siteAt(scale, { x: paper.width_px, y: 0 });
  expect(east).toBeCloseTo(50);
  expect(north).toBeCloseTo(30);
  expect(emptyPaper(null).paper.width_px).toBe(emptyPaper(null).paper.height_px);
  expect([downOf(plan, 2), downOf(plan, 1), downOf(null, 0)]).toEqual([-7, -3.2, 0]);
});

test("what encloses something needs three points", () => {
  const points = [{ x: 0, y: 0 }, { x: 1, y: 1 }];
  expect([isComplete({ kind: "wall", points }), isComplete({ kind: "outline", points })]).toEqual([true, false]);
});
