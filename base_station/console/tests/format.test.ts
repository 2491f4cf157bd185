import { describe, expect, it, vi } from "vitest";
import * as format from "../src/format";
import { loadDeferred, show } from "../src/language/catalogue";
import { problemsOf } from "../src/live/codedText";
import { alarm, HEALTH, position, STATUS, unit } from "./fixtures";

describe("words", () => {
  it.each([
    [-50, "0.0\u00a0s"],
    [440, "0.4\u00a0s"],
    [9_990, "9.9\u00a0s"],
    [10_000, "10\u00a0s"],
    [42_900, "42\u00a0s"],
    [60_000, "1\u00a0min 00\u00a0s"],
    [185_000, "3\u00a0min 05\u00a0s"],
    [3_600_000, "1\u00a0h 00\u00a0min"],
    [4_320_000, "1\u00a0h 12\u00a0min"],
  ])("say %i ms as %s", (ms, text) => {
    expect(format.duration(ms)).toBe(text);
  });

  it("say an age no finer than it is worth", () => {
    expect(format.age(42_900)).toBe("42\u00a0s");
    expect(format.age(185_000)).toBe("3\u00a0min");
  });

  it.each([
    [-1, "< 1\u00a0min"],
    [59_999, "< 1\u00a0min"],
    [60_000, "1\u00a0min"],
    [3_599_000, "59\u00a0min"],
    [7_500_000, "2\u00a0h 05\u00a0min"],
  ])("say %i ms without seconds as %s", (ms, text) => {
    expect(format.minutes(ms)).toBe(text);
  });

  it("say a date as the locale writes it", () => {
    expect(format.dateAndTime(new Date(2026, 0, 9, 8, 5, 59).getTime())).toBe("Jan 9, 2026, 08:05");
    expect(format.dateAndTime(new Date(2026, 11, 31, 23, 0).getTime())).toBe("Dec 31, 2026, 23:00");
  });

  it("say the day of a time that is of another day than the beginning", () => {
    const eve = new Date(2026, 10, 24, 23, 50).getTime();
    expect(format.timeSince(eve, eve + 60_000)).toBe("23:51:00");
    expect(format.timeSince(eve, eve + 20 * 60_000)).toBe("Nov 25, 2026, 00:10:00");
    expect(format.timeSince(eve, eve + 24 * 3_600_000)).toBe("Nov 25, 2026, 23:50:00");
  });

  it.each([
    [0, "UTC"],
    [-60, "UTC+1"],
    [-330, "UTC+5:30"],
    [210, "UTC\u22123:30"],
  ])("say the zone of a browser that is %i min behind", (offset, text) => {
    const spy = vi.spyOn(Date.prototype, "getTimezoneOffset").mockReturnValue(offset);
    expect(format.zone(0)).toBe(text);
    spy.mockRestore();
  });

  it("say what a sensor says, and that it says nothing", () => {
    expect(format.temperature(21.6)).toBe("22\u00a0°C");
    expect(format.temperature(-0.6)).toBe("-1\u00a0°C");
    expect(format.temperature(null)).toBe("no reading");
    expect(format.percent(0.64)).toBe("64\u00a0%");
    expect(format.percent(null)).toBe("unknown");
  });

  it("say how sure a position is", () => {
    expect(format.plusMinus(2.14)).toBe("±\u00a02.1\u00a0m");
    expect(format.plusMinus(31.6)).toBe("±\u00a032\u00a0m");
  });

  it.each([
    [12.2, 2.4, "13\u00a0ms ahead ±\u00a03\u00a0ms", false],
    [-75_000, 3, "1\u00a0min 15\u00a0s behind ±\u00a03\u00a0ms", true],
    [9_900, 1_500, "9.9\u00a0s ahead ±\u00a01.5\u00a0s", false],
  ])("say a clock %f ms ahead, sure to %f ms, as %s", (ahead_ms, std_ms, text, wrong) => {
    expect(format.clockOffset({ ahead_ms, std_ms })).toBe(text);
    expect(format.isClockWrong({ ahead_ms, std_ms })).toBe(wrong);
  });

  it("say a place without the plan", () => {
    expect(format.place({ north_m: 12, east_m: -3.44 })).toBe("12.0\u00a0m north, 3.4\u00a0m west");
  });

  it("say floors as people do", () => {
    expect([2, 0, -1, null].map(format.floorName)).toEqual([
      "floor 2",
      "ground floor",
      "basement 1",
      "floor unknown",
    ]);
  });

  it("says how the body is held, and how sure that is", () => {
    const held = { ...STATUS, posture: "supine", posture_confidence: 0.934 };
    expect(format.postureText(held)).toBe("Lying on the back (93\u00a0%)");
    expect(format.postureText({ ...held, mobility: "turning" })).toBe(
      "Lying on the back (93\u00a0%), turning on the spot",
    );
    expect(format.postureText({ ...STATUS, mobility: "leftward" })).toBe("stepping to the left");
    expect(format.postureText(STATUS)).toBe("");
  });

  it("say how long somebody has been motionless, and mayday before all else", () => {
    const lying = { ...STATUS, activity: "lying", motionless_s: 33 };
    expect(format.activityOf(unit("a", { status: lying }))).toBe("Lying, motionless 33\u00a0s");
    expect(format.activityOf(unit("a", { status: { ...lying, mayday: true } }))).toBe("MAYDAY");
    expect(format.activityOf(unit("a", { status: null }))).toBe("No status");
  });

  it("says no floor where another is as probable", () => {
    expect(format.floorOf(position({ floor: 1, floor_probability: 0.25 }))).toBe(
      "floor unknown, perhaps floor 1",
    );
  });

  it("says how sure a floor is only where there is a doubt", () => {
    expect(format.floorOf(position({ floor: 1, floor_probability: 0.97 }))).toBe("floor 1");
    expect(format.floorOf(position({ floor: 1, floor_probability: 0.8 }))).toBe(
      "floor 1 (80\u00a0% sure)",
    );
    expect(format.floorOf(position({ floor: null }))).toBe("floor unknown");
  });

  it("say of which time a floor is that somebody was last heard on", () => {
    const then = (of: Parameters<typeof position>[0]) => format.floorOf(position(of), true);
    expect(then({ floor: 1 })).toBe("last on floor 1");
    expect(then({ floor: 0, floor_probability: 0.8 })).toBe("last on ground floor (80\u00a0% sure)");
    expect(then({ floor: 1, floor_probability: 0.25 })).toBe("floor unknown, perhaps last on floor 1");
    expect(then({ floor: null })).toBe("floor unknown");
  });

  it.each([
    ["no-motion", "pre-alert", "No motion: pre-alert"],
    ["no-motion", "alarm", "No motion"],
    ["gps-unused", "unused", "GPS unused"],
    ["link-lost", "lost", "Link lost"],
    ["link-lost", "switched off", "Switched off"],
    ["mayday", "mayday", "Mayday"],
    ["missed-check-in", "overdue", "PAR overdue"],
  ])("say the alarm %s (%s) in short as %s", (rule, level, short) => {
    expect(format.alarmLabel(alarm("x", { rule, level }))).toBe(short);
  });

  it("name each fault of a unit, in short", () => {
    const fault = (text: string) => format.alarmLabel(alarm("x", { rule: "unit-fault", level: "fault", text }));
    expect(fault("Ana Diaz's unit: no usable inertial sample for 1 s")).toBe(
      "Unit fault: no usable inertial sample for 1 s",
    );
    const long = fault(`Ana's unit: ${"x".repeat(200)}`);
    expect(long).toMatch(/^Unit fault: x+…$/);
    expect(long.length).toBeLessThan(100);
    expect(fault("as another version says it")).toBe("Unit fault");
    const text = "The agent that tracks for Ana (FF-01@tracker): its disk is full";
    const agents = alarm("x", { rule: "tracker-fault", level: "fault", text });
    expect(format.alarmLabel(agents)).toBe("Tracker fault: its disk is full");
  });

  it("say for how long somebody is inside, and of who switched off was, until then", () => {
    const at_work = unit("a", { inside_since_ms: 60_000, last_heard_ms: 120_000 });
    expect(format.insideMs(at_work, 660_000)).toBe(600_000);
    expect(format.insideText(at_work)).toBe("Inside for");
    const lost = { ...at_work, link: "lost" } as const; // may still be in there
    expect(format.insideMs(lost, 660_000)).toBe(600_000);
    const off = { ...at_work, switched_off: true };
    expect(format.insideMs(off, 660_000)).toBe(60_000);
    expect(format.insideText(off)).toBe("Was inside");
    expect(format.insideMs(unit("a"), 660_000)).toBeNull();
    expect(format.insideText(unit("a", { switched_off: true }))).toBe("Inside for");
  });

  it("tell a unit that was switched off from one that is not heard", () => {
    expect(format.linkText(unit("a", { link: "lost" }))).toBe("Link lost");
    expect(format.linkText(unit("a", { link: "lost", switched_off: true }))).toBe("Switched off");
    expect(format.linkText(unit("a", { link: "live", switched_off: true }))).toBe("Switched off");
  });

  it("count a link that is not encrypted among the problems", () => {
    expect(problemsOf(HEALTH)).toEqual([]);
    const both = problemsOf({ ...HEALTH, problems: ["The disk is full"], insecure: true });
    expect(both[0]).toBe("The disk is full");
    expect(both[1]).toContain("Not encrypted");
  });

  it.each([
    [null, "no fix yet"],
    ["", "used"],
    ["too far from the site", "not used: too far from the site"],
  ])("say of a last fix with the reason %s: %s", (reason, text) => {
    expect(format.gpsText(reason)).toBe(text);
  });

  it("have the reason of the station in the chosen language, and another one as it came", async () => {
    await show("de");
    await loadDeferred();
    expect(format.gpsText("the receiver has no fix")).toBe("nicht verwendet: der Empfänger hat keine Position");
    expect(format.positioningReason("of another version")).toBe("of another version");
    await show("en");
  });

  it("call a temperature old after ten seconds without another one", () => {
    expect(format.isReadingOld(1_000, 10_900)).toBe(false);
    expect(format.isReadingOld(1_000, 11_000)).toBe(true);
    expect(format.isReadingOld(null, 11_000)).toBe(false);
  });

  it("list the sensors of a unit with several, hottest first", () => {
    const back = { name: "back", temperature_degc: 80.4 };
    const front = { name: "front", temperature_degc: 120.2 };
    expect(format.sensorsText([back, front])).toBe("front 120\u00a0°C, back 80\u00a0°C");
    expect(format.sensorsText([front])).toBe("");
    expect(format.hottest([back, front])).toBe(120.2);
    expect(format.hottest([])).toBeNull();
  });

  it.each([
    ["unknown", null, ""],
    ["discharging", null, ""],
    ["discharging", 7_500, "2\u00a0h 05\u00a0min left"],
    ["charging", 7_500, "charging"],
    ["full", null, "on external power"],
  ])("say of a battery that is %s with %s s: %s", (battery_state, battery_left_s, text) => {
    expect(format.batteryText({ ...STATUS, battery_state, battery_left_s })).toBe(text);
  });

  it("make initials of any name", () => {
    const names = ["Ana Kovač", "Ödön", " ", "Ana María de la Cruz", "🚒 Bo", "𐐨da"];
    expect(names.map(format.initials)).toEqual(["AK", "Ö", "", "AC", "🚒B", "𐐀"]);
  });

  it("count bytes", () => {
    expect([0, 999, 1_500, 98_000_000].map(format.bytes)).toEqual([
      "0\u00a0B",
      "999\u00a0B",
      "1.5\u00a0kB",
      "98\u00a0MB",
    ]);
  });
});

describe("where a sensor is worn", () => {
  const worn = { name: "", place: "left_foot", place_recognised: false, mount: "", model: "m" };
  it.each([
    [worn, "left foot"],
    [{ ...worn, mount: "laces" }, "left foot (laces)"],
    [{ ...worn, mount: "belt", place_recognised: true }, "left foot (belt, recognised)"],
    [{ ...worn, place: "" }, "place not known"],
  ])("says how, where that is known", (sensor, text) => {
    expect(format.wornAt(sensor)).toBe(text);
  });
});
