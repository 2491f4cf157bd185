import { describe, expect, it } from "vitest";
import { alarmCurrentValue } from "../src/live/alarmCurrentValue";
import type { AlarmView, DutyView, UnitView } from "../src/wire";
import { alarm, STATUS, unit } from "./fixtures";

const NOW_MS = 1_000_000;
const DUTY: DutyView = {
  checked_in_ms: NOW_MS - 24 * 60_000,
  checked_in_by: "chief",
  due_ms: NOW_MS - 4 * 60_000,
  asked_ms: null,
  work_since_ms: NOW_MS - 52 * 60_000,
  rest_since_ms: null,
  rest_due_ms: NOW_MS - 12 * 60_000,
  confirmed: "radio",
  on_duty_ms: NOW_MS - 52 * 60_000,
  located: true,
  entry_id: "",
};

function said(rule: string, change: Partial<UnitView>, of: Partial<AlarmView> = {}, silent = false): string {
  const heard = { last_heard_ms: NOW_MS - 300, status_ms: NOW_MS - 500 };
  const raised = alarm("a", { rule, text: "Ana: 48 of it", ...of });
  const ana = unit("a", { label: "Ana", ...heard, ...change });
  const words = alarmCurrentValue(raised, ana, NOW_MS, silent);
  return words.replaceAll("\u00a0", " ");
}

describe("alarmCurrentValue", () => {
  it.each<[string, Partial<UnitView>, string]>([
    ["heat", { ambient_degc: 80.4 }, "now 80 °C, 0 %"],
    ["heat", { ambient_degc: 80.4, heat_used: 0.65, link: "lost" }, "last 80 °C, 65 %"],
    ["heat-dose", { ambient_degc: 25, heat_used: 1.12 }, "now 112 %"],
    ["heat-dose", { ambient_degc: 25, heat_used: 1.12, link: "stale" }, "last 112 %"],
    ["heat-dose", { ambient_degc: null }, ""],
    ["heat", { ambient_degc: null }, ""],
    ["battery", { status: { ...STATUS, battery: 0.04 } }, "now 4 %"],
    ["battery", { status: { ...STATUS, battery: 0.04 }, link: "stale" }, "last 4 %"],
    ["battery", { status: { ...STATUS, battery: null } }, ""],
    ["no-motion", { status: { ...STATUS, motionless_s: 95 } }, "now 1 min 35 s"],
    ["no-motion", { status: { ...STATUS, motionless_s: 95 }, link: "lost" }, "last 1 min 35 s"],
    ["no-motion", { status: { ...STATUS, motionless_s: 2 } }, "has moved since"],
    ["no-motion", { status: { ...STATUS, motionless_s: 2 }, link: "lost" }, "has moved since"],
    ["no-motion", { status: null }, ""],
    ["link-lost", { last_heard_ms: NOW_MS - 71_000, link: "lost" }, "now 1 min 11 s"],
    ["link-lost", { link: "live" }, "now 0.3 s"],
    ["missed-check-in", { duty: DUTY }, "now 24 min"],
    ["missed-check-in", { duty: { ...DUTY, checked_in_ms: null, confirmed: "not_yet" } }, "now 52 min"],
    ["missed-check-in", { duty: DUTY, link: "lost" }, "now 24 min"],
    ["missed-check-in", { duty: null }, ""],
    ["rest-due", { duty: DUTY }, "now 52 min"],
    ["rest-due", { duty: { ...DUTY, work_since_ms: null } }, ""],
    ["fall", {}, ""],
    ["mayday", {}, ""],
  ])("of %s with %o is “%s”", (rule, change, figure) => {
    expect(said(rule, change)).toBe(figure);
  });

  it("is the last where the station is not heard, and counts on nothing", () => {
    expect(said("heat", { ambient_degc: 80 }, {}, true)).toBe("last 80 °C, 0 %");
    expect(said("link-lost", { link: "lost" }, {}, true)).toBe("");
    expect(said("missed-check-in", { duty: DUTY }, {}, true)).toBe("");
  });

  it("is none of a unit that was switched off in order: its silence is no figure", () => {
    const off = { switched_off: true, link: "lost", last_heard_ms: 0 } as const;
    expect(said("link-lost", off, { level: "switched off" })).toBe("");
  });

  it("is none where somebody else wears the unit now: it is not theirs", () => {
    const still = { status: { ...STATUS, motionless_s: 95 } };
    expect(said("no-motion", still, { text: "Bo has not moved for 30 s" })).toBe("");
    expect(said("heat", { ambient_degc: 80 }, { text: "123 °C around Bo" })).toBe("now 80 °C, 0 %");
  });
});
