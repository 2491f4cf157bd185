import { describe, expect, it } from "vitest";
import { eachRaising, LEAD_MS, nextAlarmMs, previousAlarmMs, within } from "../src/live/replaying";

const ALARMS = [{ raised_ms: 60_000 }, { raised_ms: 100_000 }];

describe("from alarm to alarm", () => {
  it("goes on to a little before the next", () => {
    expect(nextAlarmMs(ALARMS, 0)).toBe(60_000 - LEAD_MS);
    expect(nextAlarmMs(ALARMS, 60_000 - LEAD_MS)).toBe(100_000 - LEAD_MS);
    expect(nextAlarmMs(ALARMS, 100_000)).toBeNull();
  });

  it("goes back to the last, and pressed again to the one before", () => {
    expect(previousAlarmMs(ALARMS, 120_000)).toBe(100_000 - LEAD_MS);
    expect(previousAlarmMs(ALARMS, 100_000 - LEAD_MS + 500)).toBe(60_000 - LEAD_MS);
    expect(previousAlarmMs(ALARMS, 10_000)).toBeNull();
  });

  it("stops wherever one was raised anew, between the others", () => {
    const alarms = eachRaising([
      { alarm_id: "late", raised_ms: 100_000, again_ms: [] },
      { alarm_id: "early", raised_ms: 60_000, again_ms: [80_000, 140_000] },
    ]);
    const shown = alarms.map(({ alarm_id, raised_ms }) => [alarm_id, raised_ms]);
    expect(shown).toEqual([["early", 60_000], ["early", 80_000], ["late", 100_000], ["early", 140_000]]);
    expect(nextAlarmMs(alarms, 60_000)).toBe(80_000 - LEAD_MS);
    expect(previousAlarmMs(alarms, 200_000)).toBe(140_000 - LEAD_MS);
  });

  it("stays within the incident", () => {
    expect(within(-5, 0, 10)).toBe(0);
    expect(within(50, 0, 10)).toBe(10);
  });
});
