import { describe, expect, it } from "vitest";
import type { AlarmExplanationAnswer } from "../src/answers";
import { crossingText, thresholdsText } from "../src/timeline/explanation";

const NO_MOTION: AlarmExplanationAnswer = {
  alarm_id: "a",
  rule: "no-motion",
  raised_ms: 60_000,
  motionless_s: [],
  temperature_degc: [],
  battery_level: [],
  height_m: [],
  stated_error_m: [],
  live_ms: [],
  buttons_ms: [],
  thresholds: { pre_alert_s: 20, alarm_s: 30 },
  crossing: { series: "motionless_s", threshold: "alarm_s", limit: 30, t_ms: 60_000, value: 30.44 },
};

describe("the reason of an alarm", () => {
  it("is the value, and the threshold that it crossed", () => {
    expect(crossingText(NO_MOTION)).toMatch(
      /^At \d\d:\d\d:00 time without motion was 30\.4\u00a0s, beyond the threshold “alarm” \(30\u00a0s\)\.$/,
    );
  });

  it("is none where the rule judges no values", () => {
    expect(crossingText({ ...NO_MOTION, crossing: null })).toBeNull();
  });

  it("has the level of a battery in per cent", () => {
    const crossing = { series: "battery", threshold: "low", limit: 0.2, t_ms: 0, value: 0.19 };
    const low = { ...NO_MOTION, thresholds: { low: 0.2 }, crossing };
    expect(crossingText(low)).toContain("battery was 19\u00a0%, beyond the threshold “low” (20\u00a0%)");
    expect(thresholdsText(low)).toBe("low 20\u00a0%");
  });

  it("names all thresholds of then with their units", () => {
    expect(thresholdsText(NO_MOTION)).toBe("pre alert 20\u00a0s, alarm 30\u00a0s");
    const thresholds = { critical_degc: 260, unforeseen: 2.25 };
    expect(thresholdsText({ ...NO_MOTION, thresholds })).toBe("critical 260\u00a0°C, unforeseen 2.3");
  });
});
