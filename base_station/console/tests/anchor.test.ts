import { describe, expect, it } from "vitest";
import { anchorThrough, changeOf, doubtOf, type Known } from "../src/plan/anchor";

/** A degree of latitude and of longitude at 57.7° north, from tables of WGS-84, metres. */
const LAT_M = 111_372;
const LON_M = 59_627;

function at(north_m: number, east_m: number, trueNorthM: number, trueEastM: number): Known {
  return {
    place: { north_m, east_m },
    lat_deg: 57.7 + trueNorthM / LAT_M,
    lon_deg: 11.97 + trueEastM / LON_M,
  };
}

describe("an anchor through two points", () => {
  it("is the plan's origin where the plan is not turned", () => {
    const { anchor } = anchorThrough(at(0, 0, 0, 0), at(100, 50, 100, 50), 12);
    expect(anchor.lat_deg).toBeCloseTo(57.7, 6);
    expect(anchor.lon_deg).toBeCloseTo(11.97, 6);
    expect(anchor.plan_rotation_rad).toBeCloseTo(0, 4);
    expect(anchor.height_m).toBe(12);
  });

  it("finds by how much the plan is turned, and where its origin is", () => {
    // The plan's north is true east: 100 m along it is 100 m to the east.
    const { anchor } = anchorThrough(at(100, 0, 0, 100), at(200, 0, 0, 200), 0);
    expect(anchor.plan_rotation_rad).toBeCloseTo(Math.PI / 2, 4);
    expect(anchor.lat_deg).toBeCloseTo(57.7, 6);
    expect(anchor.lon_deg).toBeCloseTo(11.97, 6);
  });

  it("does not mind which point comes first", () => {
    const [one, other] = [at(3, 7, 10, 20), at(90, -20, 95, -8)];
    const there = anchorThrough(one, other, 0).anchor;
    const back = anchorThrough(other, one, 0).anchor;
    expect(back.lat_deg).toBeCloseTo(there.lat_deg, 9);
    expect(back.lon_deg).toBeCloseTo(there.lon_deg, 9);
    expect(back.plan_rotation_rad).toBeCloseTo(there.plan_rotation_rad, 9);
  });
});

describe("another place for a plan that has one", () => {
  const shown = { lat_deg: 57.7, lon_deg: 11.97, height_m: 12, plan_rotation_rad: 0 };

  it("says what is there, and how far people move by it", () => {
    const said = changeOf(shown, { ...shown, lat_deg: 57.7 + 30 / LAT_M, lon_deg: 11.97 - 40 / LON_M });
    expect(said).toContain("57.70000°, 11.97000°, its north towards 0.0°");
    expect(said).toContain("whoever satellites have placed moves by 50.0\u00a0m.");
    expect(changeOf(shown, { ...shown, lat_deg: 50 })).toMatch(/moves by 85\d\skm\./);
  });

  it("says by how much people are turned, the short way about", () => {
    const west = { ...shown, plan_rotation_rad: -0.02 };
    const east = { ...shown, plan_rotation_rad: 2 * Math.PI + 0.02 };
    expect(changeOf(west, east)).toContain("satellites have placed is turned by 2.3°.");
    expect(changeOf(west, east)).toContain("towards 358.9°");
  });

  it("says that of a height as well, and that nothing changes", () => {
    expect(changeOf(shown, { ...shown, height_m: 15 })).toMatch(/new one, its height changes by 3.0\sm\.$/);
    expect(changeOf(shown, shown)).toBe("");
  });
});

describe("two points are doubted", () => {
  it("when they are near each other", () => {
    expect(doubtOf(anchorThrough(at(0, 0, 0, 0), at(2, 0, 2, 0), 0))).toContain("farther apart");
  });

  it("when they are not as far apart on the Earth as on the plan", () => {
    expect(doubtOf(anchorThrough(at(0, 0, 0, 0), at(50, 0, 60, 0), 0))).toContain("another point");
  });

  it("and not when they agree", () => {
    expect(doubtOf(anchorThrough(at(0, 0, 0, 0), at(50, 0, 50.9, 0), 0))).toBe("");
  });
});
