import { describe, expect, it } from "vitest";
import type { LevelFigures, ThresholdAnswer } from "../src/answers";
import { chartLine, wantedOf } from "../src/rehearsal";

const THRESHOLDS: ThresholdAnswer[] = [
  { rule: "no-motion", threshold: "pre_alert_s", value: 20, lowest: 5, highest: 300 },
  { rule: "no-motion", threshold: "alarm_s", value: 30, lowest: 5, highest: 300 },
];

const level = (rehearsed: number | null, recorded: number | null = 2): LevelFigures => ({
  rule: "no-motion",
  level: "alarm",
  recorded: 2,
  rehearsed: 1,
  same: 0,
  earlier: 0,
  later: 0,
  missed: 0,
  added: 0,
  median_shift_s: null,
  recorded_per_hour: recorded,
  rehearsed_per_hour: rehearsed,
});

describe("what is rehearsed", () => {
  it("is what was changed", () => {
    expect(wantedOf(THRESHOLDS, { pre_alert_s: "20", alarm_s: "25" })).toEqual({
      changes: ["no-motion.alarm_s=25"],
      sweep: "",
    });
    expect(wantedOf(THRESHOLDS, { pre_alert_s: "20.0", alarm_s: "30", swept: "" })).toBeNull();
  });

  it("is a sweep from the value of the field on, and no value of it beside", () => {
    const given = { pre_alert_s: "8", alarm_s: "15", swept: "alarm_s", until: "60", step: "5" };
    expect(wantedOf(THRESHOLDS, given)).toEqual({
      changes: ["no-motion.pre_alert_s=8"],
      sweep: "no-motion.alarm_s=15:60:5",
    });
  });
});

describe("the line of a sweep", () => {
  it("goes from the first value to the last, up to the largest rate", () => {
    expect(chartLine([level(4), level(2), level(0)])).toEqual({
      points: "0.0,0.0 50.0,20.0 100.0,40.0",
      thenY: 20,
    });
  });

  it("is none of one value, or where nobody wore a unit", () => {
    expect(chartLine([level(4)])).toBeNull();
    expect(chartLine([level(null, null), level(null, null)])).toBeNull();
  });

  it("lies on the ground where nothing was raised", () => {
    expect(chartLine([level(0, 0), level(0, 0)])?.points).toBe("0.0,40.0 100.0,40.0");
  });
});
