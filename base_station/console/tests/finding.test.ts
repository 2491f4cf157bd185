import { describe, expect, it } from "vitest";
import { grouped, isFound, sought, type Sought } from "../src/live/finding";
import { headcountOf, partOf, PARTS } from "../src/live/headcount";
import { arrange } from "../src/live/urgency";
import type { DutyView, UnitView } from "../src/wire";
import { alarm, position, unit } from "./fixtures";

const DUTY: DutyView = {
  checked_in_ms: null,
  checked_in_by: "",
  due_ms: 0,
  asked_ms: null,
  work_since_ms: null,
  rest_since_ms: null,
  rest_due_ms: null,
  confirmed: "not_yet",
  on_duty_ms: 0,
  located: true,
  entry_id: "",
};

function member(unitId: string, name: string, crew: string, change: Partial<UnitView> = {}): UnitView {
  const person = { person_id: unitId, name, crew, role: "", photo_url: null };
  return unit(unitId, { person, position: position(), duty: DUTY, ...change });
}

const INSIDE = { inside_since_ms: 1 };
const RESTING = { duty: { ...DUTY, rest_since_ms: 1 } };
const ALL = [
  member("FF-01", "Ana Ruiz", "Engine 2", INSIDE),
  member("FF-02", "Bo Berg", "Engine 10", RESTING),
  member("FF-03", "Cy Ruiz", "", { position: null }),
  member("FF-04", "Di Ek", "Engine 2", { link: "never", last_heard_ms: null, position: null }),
  member("FF-05", "Ed Ho", "Engine 10", { alarms: ["fall"] }),
];
const ALARMS = new Map([["fall", alarm("fall", { rule: "fall" })]]);
const PLACES = arrange([], ALL, ALARMS, 0, false);
const NOTHING: Sought = { text: "", part: null, always: null };

describe("the headcount", () => {
  it("has everybody on scene in one part, so that the parts add up", () => {
    const { onScene, parts } = headcountOf(ALL);
    expect(parts).toEqual({ inside: 1, outside: 1, rehab: 1, not_located: 1, never_heard: 1 });
    expect(PARTS.reduce((sum, part) => sum + parts[part], 0)).toBe(onScene);
  });

  it("leaves out what is not ours, and units that lie switched off without a wearer", () => {
    const others = [
      unit("x", { registered: false }),
      unit("y", { switched_off: true }),
      unit("z", { last_heard_ms: null, link: "never" }),
    ];
    expect(headcountOf(others).onScene).toBe(0);
    expect(headcountOf([unit("used")]).onScene).toBe(1);
  });

  it("does not locate by an earlier incident, nor by a unit that was switched off inside", () => {
    const earlier = member("a", "A", "", { ...INSIDE, duty: { ...DUTY, located: false } });
    expect(partOf(earlier)).toBe("not_located");
    expect(partOf(member("a", "A", "", { ...INSIDE, switched_off: true }))).toBe("not_located");
    expect(partOf(member("a", "A", "", { switched_off: true }))).toBe("outside");
  });

  it("counts who is inside as inside, whatever was entered and however long the link is lost", () => {
    expect(partOf(member("a", "A", "", { ...INSIDE, ...RESTING, link: "lost" }))).toBe("inside");
  });
});

describe("a search", () => {
  const ids = (what: Partial<Sought>) =>
    sought(PLACES, ALL, { ...NOTHING, ...what }).map((place) => place.unitId);

  it("finds by name, unit and crew, every word of it, in any case", () => {
    expect(ids({ text: "ruiz" })).toEqual(["FF-01", "FF-03"]);
    expect(ids({ text: " ENGINE 10 " })).toEqual(["FF-05", "FF-02"]);
    expect(ids({ text: "ff-04" })).toEqual(["FF-04"]);
    expect(ids({ text: "ruiz engine" })).toEqual(["FF-01"]);
    expect(isFound(unit("x", { label: "Spare" }), "spare")).toBe(true);
  });

  it("shows everybody, those of a part of the headcount, and always who is chosen", () => {
    expect(ids({})).toHaveLength(5);
    expect(ids({ part: "rehab" })).toEqual(["FF-02"]);
    expect(ids({ part: "on_scene", text: "Engine 2" })).toEqual(["FF-01", "FF-04"]);
    expect(ids({ part: "rehab", always: "FF-04" })).toEqual(["FF-02", "FF-04"]);
    expect(ids({ part: "rehab", always: "FF-05" })).toEqual(["FF-02", "FF-05"]); // behind those found
    expect(ids({ text: "nobody has this name" })).toEqual([]);
  });
});

describe("the order of the list", () => {
  const groups = (order: "need" | "crew" | "name") =>
    grouped(PLACES, ALL, order).map(({ crew, places, down }) => [
      crew,
      places.map((place) => place.unitId.slice(-1)).join(""),
      down,
    ]);

  it("is by need, by name, or by crew with those without one last", () => {
    expect(groups("need")).toEqual([[null, "51234", 1]]);
    expect(groups("name")).toEqual([[null, "12345", 1]]);
    expect(groups("crew")).toEqual([
      ["Engine 2", "14", 0],
      ["Engine 10", "52", 1],
      ["", "3", 0],
    ]);
  });
});
