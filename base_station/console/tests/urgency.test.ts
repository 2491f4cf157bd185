import { describe, expect, it } from "vitest";
import { handedTo, hasAlarm, isOfAnother, needsOf, openAlarms, sinceMs } from "../src/live/alarms";
import { arrange, isCasualty, isJump, nameAmong, samePlaces, urgencyOf, type Place } from "../src/live/urgency";
import type { AlarmView, UnitView } from "../src/wire";
import { alarm, STATUS, unit } from "./fixtures";

const ALARMS: ReadonlyMap<string, AlarmView> = new Map([
  ["one", alarm("one", { priority: 1 })],
  ["two", alarm("two", { priority: 2 })],
  ["three", alarm("three", { priority: 3 })],
  ["off", alarm("off", { priority: 3, rule: "link-lost", level: "switched off" })],
]);

describe("samePlaces", () => {
  const ana: Place = { unitId: "a", name: "Ana", urgency: "normal", rank: 5, calmSinceMs: null };
  const bo: Place = { ...ana, unitId: "b", name: "Bo" };

  it("is so only while nothing moves and nobody gets better or worse", () => {
    expect(samePlaces([ana, bo], [{ ...ana }, { ...bo }])).toBe(true);
    expect(samePlaces([ana, bo], [bo, ana])).toBe(false);
    expect(samePlaces([ana, bo], [ana])).toBe(false);
    expect(samePlaces([ana], [ana, bo])).toBe(false);
    expect(samePlaces([ana, bo], [ana, { ...bo, urgency: "soon" }])).toBe(false);
    expect(samePlaces([ana, bo], [ana, { ...bo, rank: 4 }])).toBe(false);
    expect(samePlaces([ana, bo], [ana, { ...bo, calmSinceMs: 5 }])).toBe(false);
  });
});

describe("nameAmong", () => {
  it("tells namesakes apart", () => {
    const [ana, other] = [unit("1", { label: "Ana" }), unit("2", { label: "Ana" })];
    const units = [ana, other, unit("3", { label: "Bo" })];
    expect(units.map((one) => nameAmong(one, units))).toEqual(["Ana (1)", "Ana (2)", "Bo"]);
  });
});

describe("urgencyOf", () => {
  it.each<[string, Partial<UnitView>]>([
    ["immediate", { alarms: ["three", "one"] }],
    ["immediate", { status: { ...STATUS, mayday: true } }],
    ["immediate", { alarms: ["an alarm nobody described"] }],
    ["soon", { alarms: ["two"] }],
    ["soon", { link: "lost" }],
    ["watch", { alarms: ["three"] }],
    ["watch", { link: "stale" }],
    ["watch", { heat_level: "caution" }],
    ["normal", {}],
    ["normal", { link: "stale", switched_off: true }],
    ["normal", { link: "lost", switched_off: true }],
    ["normal", { link: "lost", switched_off: true, alarms: ["off"] }],
    ["watch", { link: "lost", switched_off: true, alarms: ["off", "three"] }],
  ])("is %s for %o", (urgency, change) => {
    expect(urgencyOf(unit("a", change), ALARMS)).toBe(urgency);
  });
});

describe("arrange", () => {
  const calm = [unit("c"), unit("a"), unit("b")];
  const cUrgent = [unit("c", { alarms: ["one"] }), unit("a"), unit("b")];
  const order = (places: readonly Place[]) => places.map((place) => place.unitId).join("");

  it("goes by name where nobody is in need", () => {
    expect(order(arrange([], calm, ALARMS, 0, false))).toBe("abc");
  });

  it("puts a mayday before a fall, and both before those who are only not heard from", () => {
    const alarms = new Map([
      ["roll", alarm("roll", { priority: 1, rule: "missed-check-in" })],
      ["fall", alarm("fall", { priority: 1, rule: "fall" })],
      ["mayday", alarm("mayday", { priority: 1, rule: "mayday" })],
    ]);
    const all = [
      unit("a", { alarms: ["roll"] }),
      unit("b", { alarms: ["battery", "roll"] }),
      unit("c", { alarms: ["fall", "roll"] }),
      unit("d", { alarms: ["mayday"] }),
      unit("e", { status: { ...STATUS, mayday: true } }),
    ];
    alarms.set("battery", alarm("battery", { priority: 2 }));
    expect(order(arrange([], all, alarms, 0, false))).toBe("decab");
    expect(order(arrange([], all, alarms, 0, false).filter(isCasualty))).toBe("dec");
  });

  it("puts whoever gets worse first at once, even while somebody points at the list", () => {
    const before = arrange([], calm, ALARMS, 0, false);
    expect(order(arrange(before, cUrgent, ALARMS, 1, true))).toBe("cab");
  });

  it("lets whoever gets better keep the place for ten seconds", () => {
    const worse = arrange([], cUrgent, ALARMS, 0, false);
    const better = arrange(worse, calm, ALARMS, 1_000, false);
    expect(order(better)).toBe("cab");
    expect(order(arrange(better, calm, ALARMS, 10_999, false))).toBe("cab");
    expect(order(arrange(better, calm, ALARMS, 11_000, false))).toBe("abc");
  });

  it("moves nobody down while somebody points at the list", () => {
    const worse = arrange([], cUrgent, ALARMS, 0, false);
    const better = arrange(worse, calm, ALARMS, 1_000, true);
    expect(order(arrange(better, calm, ALARMS, 60_000, true))).toBe("cab");
  });
});

describe("openAlarms", () => {
  it("orders by priority, then not yet acknowledged, then age; leaves out the resolved", () => {
    const alarms = [
      alarm("done", { state: "resolved" }),
      alarm("battery", { priority: 2, raised_ms: 1 }),
      alarm("taken", { state: "acknowledged", raised_ms: 2 }),
      alarm("young", { raised_ms: 9 }),
      alarm("old", { raised_ms: 5 }),
    ];
    expect(openAlarms(alarms).map((one) => one.alarm_id)).toEqual([
      "old",
      "young",
      "taken",
      "battery",
    ]);
  });
});

describe("sinceMs", () => {
  const times = { raised_ms: 5, last_raised_ms: 2_000, changed_ms: 9_000 };

  it("is when an alarm was raised last, and once it is acknowledged, when it was first", () => {
    expect(sinceMs(alarm("again", times))).toBe(2_000);
    expect(sinceMs(alarm("taken", { ...times, state: "acknowledged" }))).toBe(5);
  });
});

it("what cannot wait is the wearer's own, and more than that they have not answered", () => {
  const ana = unit("1", {
    person: { person_id: "a", name: "Ana", crew: "", role: "", photo_url: null },
    alarms: ["fall", "before", "overdue", "battery", "gone"],
  });
  const alarms = new Map([
    ["fall", alarm("fall", { rule: "fall", text: "Ana may have fallen" })],
    ["before", alarm("before", { rule: "mayday", text: "Mayday from Bo" })],
    ["overdue", alarm("overdue", { rule: "missed-check-in", text: "Ana: PAR overdue" })],
    ["battery", alarm("battery", { rule: "battery", priority: 2, text: "The battery of Ana's unit" })],
  ]);
  expect(needsOf(ana, alarms).map((one) => one.alarm_id)).toEqual(["fall"]);
});

describe("handedTo", () => {
  const mayday = alarm("mayday", { text: "Mayday from Ana" });
  const wearer = { person_id: "b", name: "Bo", crew: "", role: "", photo_url: null };

  it("is who wears the unit of an alarm that names somebody else", () => {
    expect(handedTo(mayday, unit("1", { person: { ...wearer, name: "Ana" } }))).toBe("");
    expect(handedTo(mayday, unit("1", { person: wearer }))).toBe("Bo wears this unit now");
    expect(handedTo(mayday, unit("1"))).toBe("this unit is unassigned now");
    const bob = alarm("fall", { text: "Bob (2.) may have fallen" });
    expect(handedTo(bob, unit("1", { person: wearer }))).toBe("Bo wears this unit now");
    expect(handedTo(bob, unit("1", { person: { ...wearer, name: "Bob (2.)" } }))).toBe("");
    const zoe = alarm("fault", { text: "Zoë's unit: storage fault" });
    expect(handedTo(zoe, unit("1", { person: { ...wearer, name: "Zoë" } }))).toBe("");
    expect(handedTo(zoe, unit("1", { person: { ...wearer, name: "Zo" } }))).not.toBe("");
    expect(handedTo(alarm("battery", { text: "The battery of 1's unit" }), unit("1"))).toBe("");
  });

  it("is said on a card of what befell a person, and not of what ails the unit", () => {
    const bo = unit("1", { person: wearer });
    expect(isOfAnother(alarm("m", { rule: "mayday", text: "Mayday from Ana" }), bo)).toBe(true);
    expect(isOfAnother(alarm("m", { rule: "mayday", text: "Mayday from Bo" }), bo)).toBe(false);
    const fault = alarm("f", { rule: "unit-fault", text: "Ana's unit: storage fault" });
    expect(isOfAnother(fault, bo)).toBe(false);
  });
});

it("a battery is low where its alarm is open, whatever the station's figure for that", () => {
  const alarms = new Map([["low", alarm("low", { rule: "battery" })]]);
  expect(hasAlarm(unit("1", { alarms: ["low"] }), "battery", alarms)).toBe(true);
  expect(hasAlarm(unit("1", { alarms: ["low"] }), "heat", alarms)).toBe(false);
  expect(hasAlarm(unit("1", { alarms: [] }), "battery", alarms)).toBe(false);
});

it("a jump in the past is one, and time that goes by is none", () => {
  expect(isJump(60_000, 59_000)).toBe(true);
  expect(isJump(60_000, 66_000)).toBe(true);
  expect(isJump(60_000, 60_500)).toBe(false);
});
