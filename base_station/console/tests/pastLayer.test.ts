import type Feature from "ol/Feature";
import type MultiLineString from "ol/geom/MultiLineString";
import { describe, expect, it } from "vitest";
import type { Colours } from "../src/plan/colours";
import { PastLayer } from "../src/plan/pastLayer";
import type { TrailKind } from "../src/plan/pastTrails";
import { TRAIL_MS } from "../src/plan/trail";
import type { TrailPoint } from "../src/wire";

const COLOURS = { quiet: "#666666", watch: "#0000ff", normal: "#00ff00" } as Colours;
const NOW_MS = 3 * TRAIL_MS;
const STEP_MS = 1_000;
/** North a metre a second, from the beginning until now and on. */
const WALK: TrailPoint[] = Array.from({ length: (4 * TRAIL_MS) / STEP_MS }, (_, step) => [
  step * STEP_MS,
  step,
  0,
  0,
]);

/** How many points each line has. */
function drawn(chosen: string | null, shown: ReadonlyMap<string, TrailPoint[]> = new Map()): number[] {
  const kinds: TrailKind[] = ["fused", "raw", "smoothed"];
  const past = kinds.map((kind) => ({ kind, trails: new Map([["a", WALK], ["b", WALK]]) }));
  const layer = new PastLayer();
  layer.show({ past, shown, nowMs: NOW_MS, floor: "all", chosen }, COLOURS);
  const features = layer.layer.getSource()?.getFeatures() as Feature<MultiLineString>[];
  return features.map((one) => one.getGeometry()?.getCoordinates().flat().length ?? 0);
}

describe("trails over one another", () => {
  it("are as long as one another: of everybody the last minutes, so that the plan is seen", () => {
    const lengths = drawn(null);
    expect(lengths).toHaveLength(6);
    expect(new Set(lengths)).toEqual(new Set([TRAIL_MS / STEP_MS + 1]));
  });

  it("are of what was shown only what is not drawn anyway: what came late was not shown then", () => {
    const kept = WALK.slice(600, 700);
    expect(drawn("b", new Map([["b", kept]]))).toEqual([601, ...Array(2).fill(NOW_MS / STEP_MS + 1)]);
  });

  it("are of a chosen person alone, from the beginning until now", () => {
    const lengths = drawn("b");
    expect(lengths).toHaveLength(3);
    expect(new Set(lengths)).toEqual(new Set([NOW_MS / STEP_MS + 1]));
  });
});
