import { describe, expect, it } from "vitest";
import type { TimelineAnswer } from "../src/answers";
import {
  bounded,
  extremes,
  LONGEST_MS,
  moved,
  SHORTEST_MS,
  STRIPS,
  valueAt,
  within,
  zoomed,
} from "../src/timeline/series";

const EMPTY = { t_ms: [], values: [] };
const TIMELINE: TimelineAnswer = {
  unit_id: "FF-01",
  from_ms: 0,
  until_ms: 60_000,
  temperature_degc: { t_ms: [1000, 2000, 2001, 30_000], values: [20.04, 180, null, 21] },
  height_m: EMPTY,
  floor: { t_ms: [1000], values: [-1] },
  activity: { t_ms: [1000, 2000], values: [2, 8] },
  activity_names: ["unknown", "still", "walking", "running", "", "", "", "", "falling"],
  battery: { t_ms: [1000], values: [0.5] },
  position_error_m: EMPTY,
  silence_s: EMPTY,
  radio_gaps_ms: [],
  defects: [],
  defect_codes: [],
};

function strip(column: string) {
  return STRIPS.find((one) => one.column === column)!;
}

describe("the value at a moment", () => {
  it("is the last until then, and none before the first or in a gap", () => {
    const at = (ms: number) => valueAt(TIMELINE.temperature_degc, ms);
    expect([0, 999, 1000, 1999, 2000].map(at)).toEqual([null, null, 20.04, 20.04, 180]);
    expect([2001, 29_999, 30_000, 99_999].map(at)).toEqual([null, null, 21, 21]);
    expect(valueAt(EMPTY, 1000)).toBeNull();
  });

  it("has its unit, and words for activities and floors", () => {
    const text = (column: string, value: number) => strip(column).text(value, TIMELINE);
    expect(text("temperature_degc", 20.04)).toBe("20.0\u00a0°C");
    expect(text("height_m", -3)).toBe("-3.0\u00a0m");
    expect(text("activity", 8)).toBe("Falling");
    expect(text("activity", 99)).toBe("Unknown");
    expect(text("battery", 0.5)).toBe("50\u00a0%");
    expect(text("silence_s", 41)).toBe("41\u00a0s");
  });

  it("is also given in words for a whole line", () => {
    expect(extremes(strip("temperature_degc"), TIMELINE)).toBe("20.0\u00a0°C to 180.0\u00a0°C");
    expect(extremes(strip("floor"), TIMELINE)).toBe("basement 1");
    expect(extremes(strip("height_m"), TIMELINE)).toBeNull();
  });
});

describe("the part of the time that is shown", () => {
  const whole = { fromMs: 1_000_000, untilMs: 1_400_000 };

  it("is zoomed about its middle and stays in the whole", () => {
    const half = zoomed(whole, 0.5, whole);
    expect(half).toEqual({ fromMs: 1_100_000, untilMs: 1_300_000 });
    expect(zoomed(half, 2, whole)).toEqual(whole);
    expect(zoomed(half, 8, whole)).toEqual(whole);
    expect(zoomed(half, 0, whole)).toEqual({ fromMs: 1_200_000, untilMs: 1_200_000 + SHORTEST_MS });
  });

  it("moves by half of its length, up to either end", () => {
    const part = { fromMs: 1_000_000, untilMs: 1_200_000 };
    const next = moved(part, 1, whole);
    expect(next).toEqual({ fromMs: 1_100_000, untilMs: 1_300_000 });
    expect(moved(next, -1, whole)).toEqual(part);
    expect(moved(part, -1, whole)).toEqual(part);
    expect(moved({ fromMs: 1_200_000, untilMs: 1_400_000 }, 1, whole).untilMs).toBe(1_400_000);
  });

  it("is never longer than the whole, however short that is", () => {
    const short = { fromMs: 5, untilMs: 905 };
    expect(within({ fromMs: 0, untilMs: 500_000 }, short)).toEqual(short);
    expect(zoomed(short, 0.5, short)).toEqual(short);
  });

  it("is at most what the station gives", () => {
    expect(bounded({ fromMs: 0, untilMs: 3 * LONGEST_MS })).toEqual({
      fromMs: 2 * LONGEST_MS,
      untilMs: 3 * LONGEST_MS,
    });
  });
});
