import { describe, expect, it } from "vitest";
import { alarmRows, floodText, raisedOf, singleRows, takenBy } from "../src/live/alarmRows";
import { openAlarms } from "../src/live/alarms";
import type { AlarmView } from "../src/wire";
import { alarm } from "./fixtures";

const T_MS = new Date(2026, 10, 21, 14, 2, 5).getTime();

function lost(count: number, change: (index: number) => Partial<AlarmView> = () => ({})): AlarmView[] {
  return Array.from({ length: count }, (_, index) =>
    alarm(`lost ${index}`, {
      rule: "link-lost",
      priority: 2,
      unit_id: `u${index}`,
      raised_ms: T_MS + 20 * index,
      ...change(index),
    }),
  );
}

function keys(alarms: AlarmView[]): string[][] {
  return alarmRows(openAlarms(alarms)).map((row) => row.alarms.map((one) => one.alarm_id));
}

describe("rows of alarms", () => {
  it("are one for each member, the most urgent cause first", () => {
    const fall = alarm("fall", { rule: "fall", unit_id: "a", raised_ms: 5 });
    const heat = alarm("heat", { rule: "heat", unit_id: "a", priority: 2, raised_ms: 1 });
    const other = alarm("other", { rule: "heat", unit_id: "b", priority: 2, raised_ms: 2 });
    expect(keys([heat, other, fall])).toEqual([["fall", "heat"], ["other"]]);
  });

  it("are one for each alarm that is of no unit", () => {
    const both = ["x", "y"].map((id) => alarm(id, { unit_id: "", rule: "disk" }));
    expect(keys(both)).toEqual([["x"], ["y"]]);
  });

  it("are one for a flood, however many units it is of", () => {
    const [row, ...others] = alarmRows(openAlarms(lost(200)));
    expect(others).toEqual([]);
    expect(row?.isFlood).toBe(true);
    expect(floodText(row!)).toBe("200 units lost their link at 14:02");
  });

  it("leave few, those of another time and those of other kinds apart", () => {
    expect(keys(lost(4))).toHaveLength(4);
    const later = lost(8, (index) => ({ raised_ms: T_MS + (index < 4 ? 0 : 600_000) }));
    expect(keys(later)).toHaveLength(8);
    const mixed = lost(8, (index) => ({ rule: index < 4 ? "link-lost" : "heat" }));
    expect(keys(mixed)).toHaveLength(8);
  });

  it("never put a member who is down into a flood", () => {
    const fall = alarm("fall", { rule: "fall", unit_id: "u3", raised_ms: T_MS });
    const rows = alarmRows(openAlarms([...lost(20), fall]));
    expect(rows.map((row) => row.alarms.length)).toEqual([2, 19]);
    expect(rows[0]?.alarms.map((one) => one.alarm_id)).toEqual(["fall", "lost 3"]);
  });

  it("fold overdue PARs of many, but not the falls of many", () => {
    const overdue = lost(6, () => ({ rule: "missed-check-in", level: "overdue", priority: 1 }));
    expect(floodText(alarmRows(overdue)[0]!)).toBe("6 PARs overdue at 14:02");
    expect(keys(lost(6, () => ({ rule: "fall", priority: 1 })))).toHaveLength(6);
  });

  it("count a unit once", () => {
    expect(keys(lost(6, () => ({ unit_id: "a" })))).toHaveLength(1);
    expect(alarmRows(lost(6, () => ({ unit_id: "a" })))[0]?.isFlood).toBe(false);
  });

  it("say from when to when, and what", () => {
    const slow = lost(9, (index) => ({ raised_ms: T_MS + 20_000 * index, rule: "heat" }));
    expect(floodText(alarmRows(slow)[0]!)).toBe("9 units: Heat, from 14:02 to 14:04");
    const off = lost(5, () => ({ level: "switched off", priority: 3 }));
    expect(floodText(alarmRows(off)[0]!)).toBe("5 units were switched off at 14:02");
  });

  it("know what nobody has acknowledged, and who has", () => {
    const by = (index: number) => (index < 3 ? { state: "acknowledged", by: "mia" } : {});
    const [row] = alarmRows(openAlarms(lost(6, by)));
    expect(raisedOf(row!)).toHaveLength(3);
    const [taken] = alarmRows(lost(6, (i) => ({ state: "acknowledged", by: i < 2 ? "mia" : "chief" })));
    expect(takenBy(taken!)).toBe("mia, chief");
  });

  it("are single where they are listed", () => {
    expect(singleRows(lost(7)).map((row) => row.alarms.length)).toEqual([1, 1, 1, 1, 1, 1, 1]);
  });
});
