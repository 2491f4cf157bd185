import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { anchorThrough, siteOf } from "../src/plan/anchor";
import type { BaseMap } from "../src/api";
import {
  AGAIN_MS,
  baseMap,
  cornersOf,
  crsOf,
  earthAt,
  keepBaseMap,
  worldOf,
} from "../src/plan/baseMap";

let answer: () => Promise<BaseMap | null> = () => Promise.resolve(null);
vi.mock("../src/api", () => ({ baseMap: () => answer() }));

const MAP: BaseMap = {
  image_url: "/api/v1/site/base-map/x",
  upper_left: [52.001, 4.0],
  upper_right: [52.001, 4.002],
  lower_left: [52.0, 4.0],
};

describe("the base map", () => {
  it("reads the six numbers of a world file, and says where there are none", () => {
    expect(worldOf("1e-5\r\n0.0\r\n0\r\n-1e-5\r\n4\r\n52\r\n")).toEqual([1e-5, 0, 0, -1e-5, 4, 52]);
    expect(worldOf("1 2 3")).toBeNull();
    expect(worldOf("<html>")).toBeNull();
    expect(worldOf("1 2 3 4 5 six")).toBeNull();
  });

  it("takes the grid as given, else as the numbers say", () => {
    expect(crsOf("25832", [0.2, 0, 0, -0.2, 500_000, 5_761_000])).toBe("EPSG:25832");
    expect(crsOf("", [1, 0, 0, -1, 445_278, 6_800_125])).toBe("EPSG:3857");
    expect(crsOf("", [1e-5, 0, 0, -1e-5, 4, 52])).toBe("EPSG:4326");
  });

  it("knows where a click on it lies", () => {
    const [lat, lon] = earthAt(MAP, 0.5, 0.25);
    expect(lat).toBeCloseTo(52.00075, 9);
    expect(lon).toBeCloseTo(4.001, 9);
  });

  it("lies on the plan where two clicks have put the plan", () => {
    const one = { place: { north_m: 10, east_m: 5 }, lat_deg: 52.0004, lon_deg: 4.0006 };
    const other = { place: { north_m: 40, east_m: 65 }, lat_deg: 52.0, lon_deg: 4.0006 + 0.0007 };
    const { anchor } = anchorThrough(one, other, 0);
    const back = siteOf(anchor, one.lat_deg, one.lon_deg);
    const apart = siteOf(anchor, other.lat_deg, other.lon_deg);
    const turn = Math.atan2(apart.east_m - back.east_m, apart.north_m - back.north_m);
    expect(turn).toBeCloseTo(Math.atan2(60, 30), 4);
    const [upperLeft, upperRight, lowerLeft] = cornersOf(MAP, { ...anchor, plan_rotation_rad: 0 });
    expect(upperRight.east_m - upperLeft.east_m).toBeCloseTo(0.002 * 68_680, -1);
    expect(upperLeft.north_m - lowerLeft.north_m).toBeCloseTo(0.001 * 111_267, 0);
  });
});

describe("the base map of the station", () => {
  beforeEach(() => {
    vi.useFakeTimers();
    baseMap.value = null;
  });
  afterEach(() => {
    vi.useRealTimers();
  });

  it("is shown as somebody else sets and removes it, and stays where the station does not say", async () => {
    answer = () => Promise.resolve(null);
    const end = keepBaseMap();
    await vi.advanceTimersByTimeAsync(AGAIN_MS);
    expect(baseMap.value).toBeNull();
    answer = () => Promise.resolve({ ...MAP });
    await vi.advanceTimersByTimeAsync(AGAIN_MS);
    expect(baseMap.value).toEqual(MAP);
    const shown = baseMap.value;
    await vi.advanceTimersByTimeAsync(AGAIN_MS);
    expect(baseMap.value, "the same is not drawn again").toBe(shown);
    answer = () => Promise.reject(new Error("The station cannot be reached."));
    await vi.advanceTimersByTimeAsync(AGAIN_MS);
    expect(baseMap.value).toEqual(MAP);
    answer = () => Promise.resolve(null);
    await vi.advanceTimersByTimeAsync(AGAIN_MS);
    expect(baseMap.value).toBeNull();
    end();
    answer = () => Promise.resolve(MAP);
    await vi.advanceTimersByTimeAsync(2 * AGAIN_MS);
    expect(baseMap.value, "nobody is logged in").toBeNull();
  });

  it("is not what it was when it was asked for, where it was set here since", async () => {
    let say: (map: BaseMap | null) => void = () => undefined;
    answer = () => new Promise((resolve) => (say = resolve));
    const end = keepBaseMap();
    baseMap.value = MAP;
    say(null);
    await vi.advanceTimersByTimeAsync(0);
    expect(baseMap.value).toEqual(MAP);
    end();
  });
});
