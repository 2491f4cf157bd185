import { describe, expect, it } from "vitest";
import { eachRaising, LEAD_MS, nextAlarmMs, previousAlarmMs, within } from "../src/live/replaying";

const ALARMS = [{ raised_ms: 60_000 }, { raised_ms: 100_000 }];

function raised(texts: Record<number, string>) {
  const sentence = { code: "", parameters: {} };
  const raisings = Object.entries(texts).map(([ms, text]) => ({ ...sentence, t_ms: Number(ms), text }));
  return { raised_ms: raisings[0]?.t_ms ?? 0, ...sentence, text: raisings.at(-1)?.text ?? "", raisings };
}

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
      raised({ 100_000: "late" }),
      raised({ 60_000: "hot", 80_000: "hotter", 140_000: "hottest" }),
    ]);
    const shown = alarms.map(({ raised_ms, text }) => [raised_ms, text]);
    expect(shown).toEqual([
      [60_000, "hot"],
      [80_000, "hotter"],
      [100_000, "late"],
      [140_000, "hottest"],
    ]);
    expect(nextAlarmMs(alarms, 60_000)).toBe(80_000 - LEAD_MS);
    expect(previousAlarmMs(alarms, 200_000)).toBe(140_000 - LEAD_MS);
  });

  it("stays within the incident", () => {
    expect(within(-5, 0, 10)).toBe(0);
    expect(within(50, 0, 10)).toBe(10);
  });
});
