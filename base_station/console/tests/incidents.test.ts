import { describe, expect, it } from "vitest";
import { choicesOf, cutTo, shownIncident, unassignedUnits } from "../src/live/incidents";
import { alarmRows } from "../src/live/alarmRows";
import { Picture } from "../src/live/picture";
import { apply, type State } from "../src/live/state";
import type { IncidentView, Plan, Snapshot } from "../src/wire";
import { alarm, command, externalMarker, position, snapshot, unit } from "./fixtures";

const PLAN = { type: "FeatureCollection", features: [], muster: {} } as unknown as Plan;
const HARBOUR_PLAN = { ...PLAN, muster: { name: "Harbour" } } as unknown as Plan;

function incident(incident_id: string, site_id: string, change: Partial<IncidentView> = {}): IncidentView {
  return {
    incident_id,
    name: incident_id,
    opened_ms: 0,
    closed_ms: null,
    par_interval_s: 1200,
    par_warning_s: 300,
    work_limit_s: 2400,
    dispatch: null,
    site_id,
    ...change,
  };
}

const LANE = incident("Lane", "");
const HARBOUR = incident("Harbour", "s1");

/** Ann in the lane, Bo at the harbour, Cy in none; the station names the one opened last. */
function two(change: Partial<Snapshot> = {}): State {
  const { state } = apply(
    null,
    snapshot({
      incident: HARBOUR,
      incidents: [LANE, HARBOUR],
      plan: HARBOUR_PLAN,
      sites: [{ site_id: "", plan: PLAN, anchor: null, plan_placed: true }],
      units: [
        unit("ann", { incident_id: "Lane", position: position() }),
        unit("bo", { incident_id: "Harbour", position: position() }),
        unit("cy", { incident_id: null }),
      ],
      alarms: [alarm("a", { unit_id: "ann" }), alarm("b", { unit_id: "bo" })],
      commands: [command("to-ann", { ann: "sent" }, { incident_id: "" }), command("of-harbour", {}, { incident_id: "Harbour" })],
      external: [externalMarker({ marker_id: "m" }), externalMarker({ marker_id: "m", site_id: "s1" })],
      ...change,
    }),
  );
  if (state === null) throw new Error("a snapshot gives a state");
  return state;
}

describe("one of several incidents", () => {
  it("has its own ground and people, and nothing of others", () => {
    const lane = cutTo(two(), LANE);
    expect([...lane.units.keys()]).toEqual(["ann"]);
    expect(lane.plan).toEqual(PLAN);
    expect([...lane.commands.keys()]).toEqual(["to-ann"]);
    expect(lane.external.map((one) => one.site_id)).toEqual([""]);
    const harbour = cutTo(two(), HARBOUR);
    expect([...harbour.units.keys()]).toEqual(["bo"]);
    expect(harbour.plan).toEqual(HARBOUR_PLAN);
    expect([...harbour.commands.keys()]).toEqual(["of-harbour"]);
  });

  it("leaves the alarms of all", () => {
    expect([...cutTo(two(), LANE).alarms.keys()]).toEqual(["a", "b"]);
  });

  it("shows who is in no open incident apart", () => {
    const state = two();
    expect(unassignedUnits(state, cutTo(state, LANE)).map((one) => one.unit_id)).toEqual(["cy"]);
    const closed = two({ incident: LANE, incidents: [LANE, { ...HARBOUR, closed_ms: 5 }] });
    expect(unassignedUnits(closed, cutTo(closed, LANE)).map((one) => one.unit_id)).toEqual(["bo", "cy"]);
  });

  it("counts the open alarms of each", () => {
    const state = two({ alarms: [alarm("a", { unit_id: "ann" }), alarm("b", { unit_id: "bo", state: "resolved" })] });
    expect(choicesOf(state).map((one) => [one.incident.name, one.openAlarms])).toEqual([["Lane", 1], ["Harbour", 0]]);
  });

  it("is the wanted one while it is open, and else the one of the station", () => {
    expect(shownIncident(two(), ["Lane", "Harbour"])).toEqual(LANE);
    expect(shownIncident(two(), ["gone", "Lane"])).toEqual(LANE);
    expect(shownIncident(two(), [null, null])).toEqual(HARBOUR);
    const closed = two({ incident: LANE, incidents: [LANE, { ...HARBOUR, closed_ms: 5 }] });
    expect(shownIncident(closed, ["Harbour", null])).toEqual(LANE);
  });

  it("is the whole picture, untouched, where the station has one ground", () => {
    const state = two({ incident: LANE, incidents: [LANE], sites: [] });
    expect(cutTo(state, LANE)).toBe(state);
    expect(unassignedUnits(state, cutTo(state, LANE))).toEqual([]);
    expect(choicesOf(state)).toEqual([]);
  });
});

describe("a picture of several incidents", () => {
  it("stays with its incident when another is opened beside it, and turns when that is chosen", () => {
    const picture = new Picture();
    picture.show(two({ incident: LANE, incidents: [LANE], sites: [], plan: PLAN }));
    picture.show(two());
    expect(picture.incident.value).toEqual(LANE);
    expect(picture.allUnits().map((one) => one.unit_id)).toEqual(["ann"]);
    expect(picture.otherIncidentOf("bo")).toEqual(HARBOUR);
    expect(picture.otherIncidentOf("cy")).toBeNull();
    const before = picture.unitsChanged.value;
    picture.choose("Harbour");
    expect(picture.unitsChanged.value).toBeGreaterThan(before);
    expect(picture.allUnits().map((one) => one.unit_id)).toEqual(["bo"]);
    expect(picture.plan.value).toEqual(HARBOUR_PLAN);
    expect(picture.openAlarms.value).toHaveLength(2);
  });

  it("has its people where a list of the ground is none, with one incident and with several", () => {
    const broken = { beacons: null, pins: 5, external: [null] } as unknown as Partial<Snapshot>;
    for (const state of [two(broken), two({ ...broken, incident: LANE, incidents: [LANE], sites: [] })]) {
      const picture = new Picture();
      picture.show(state);
      picture.show({ ...state, seq: state.seq + 1 });
      expect(picture.allUnits().length).toBeGreaterThan(0);
      expect(picture.unitIds.value).toEqual(["ann", "bo", "cy"]);
      expect(picture.pins.value).toBe(5);
    }
  });

  it("keeps its lists while they are the same", () => {
    const picture = new Picture();
    const state = two();
    picture.show(state);
    const { external, commands } = picture;
    const before = [external.value, commands.value];
    picture.show({ ...state, seq: state.seq + 1 });
    expect([external.value, commands.value]).toEqual(before);
    expect(external.value).toBe(before[0]);
    expect(commands.value).toBe(before[1]);
  });
});

it("a flood of alarms is of one incident", () => {
  const ids = Array.from({ length: 10 }, (_, i) => `u${i}`);
  const open = ids.map((unit_id) => alarm(`of ${unit_id}`, { unit_id, rule: "link-lost", priority: 2 }));
  expect(alarmRows(open)).toHaveLength(1);
  const rows = alarmRows(open, (unitId) => (Number(unitId.slice(1)) < 5 ? "Lane" : "Harbour"));
  expect(rows.map((row) => row.alarms.length)).toEqual([5, 5]);
});
