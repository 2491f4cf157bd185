import { describe, expect, it } from "vitest";
import { LEAD_MS, nextAlarmMs, previousAlarmMs, within } from "../src/live/replaying";

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

  it("stays within the incident", () => {
    expect(within(-5, 0, 10)).toBe(0);
    expect(within(50, 0, 10)).toBe(10);
  });
});
