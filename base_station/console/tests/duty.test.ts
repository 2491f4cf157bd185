import { describe, expect, it } from "vitest";
import { confirmationWords, crewsOnDuty, parOf, rollCall } from "../src/live/duty";
import type { DutyView, IncidentView, UnitView } from "../src/wire";
import { countdown, timeLeft } from "../src/format";
import { unit } from "./fixtures";

const INCIDENT: IncidentView = {
  incident_id: "i",
  name: "Mill Road 7",
  opened_ms: 0,
  closed_ms: null,
  par_interval_s: 1200,
  par_warning_s: 300,
  work_limit_s: 2400,
  dispatch: null,
  site_id: "",
};

function duty(dueMs: number, change: Partial<DutyView> = {}): DutyView {
  return {
    checked_in_ms: 0,
    checked_in_by: "chief",
    due_ms: dueMs,
    asked_ms: null,
    work_since_ms: null,
    rest_since_ms: null,
    rest_due_ms: null,
    confirmed: "radio",
    on_duty_ms: 0,
    located: true,
    entry_id: "k1",
    ...change,
  };
}

function onDuty(unitId: string, crew: string, dueMs: number, change: Partial<DutyView> = {}): UnitView {
  const person = { person_id: unitId, name: unitId, crew, role: "", photo_url: null };
  return unit(unitId, { person, duty: duty(dueMs, change) });
}

describe("a check-in", () => {
  it.each([
    [1_200_000, "green"],
    [300_001, "green"],
    [300_000, "warning"],
    [1, "warning"],
    [0, "overdue"],
    [-60_000, "overdue"],
  ])("that is due in %i ms is %s", (dueMs, state) => {
    const nowMs = 5_000_000;
    const par = parOf(duty(nowMs + dueMs), INCIDENT, nowMs);
    expect(par).toEqual({ state, leftMs: dueMs });
  });

  it.each([
    [1_200_000, "unconfirmed"],
    [300_000, "warning"],
    [0, "overdue"],
  ])("of whom none was confirmed, due in %i ms, is %s and never green", (dueMs, state) => {
    expect(parOf(duty(dueMs, { confirmed: "not_yet" }), INCIDENT, 0).state).toBe(state);
  });

  it("says who or what confirmed it", () => {
    const at = new Date(2026, 0, 1, 18, 47, 18).getTime();
    const words = (change: Partial<DutyView>) => confirmationWords(duty(0, { checked_in_ms: at, ...change }));
    expect(words({})).toBe("confirmed 18:47:18 by radio, entered by chief");
    expect(words({ confirmed: "self" })).toBe("confirmed 18:47:18 by own unit");
    expect(words({ confirmed: "not_yet", checked_in_ms: null })).toBe("not yet confirmed");
  });

  it("is announced by nobody where no incident says how long before", () => {
    expect(parOf(duty(1), null, 0).state).toBe("green");
    expect(parOf(duty(0), null, 0).state).toBe("overdue");
  });
});

describe("the roll call", () => {
  const units = [
    onDuty("a", "red", 900_000),
    onDuty("b", "blue", -1_000),
    onDuty("c", "red", 200_000),
    unit("d"),
  ];

  it("orders crews whose PAR is due at the same time by the number in their names", () => {
    const crews = ["Ladder 10", "Ladder 2", "Ladder 1"].map((crew) => onDuty(crew, crew, 900_000));
    expect(crewsOnDuty(crews, INCIDENT, 0).map(({ crew }) => crew)).toEqual(["Ladder 1", "Ladder 2", "Ladder 10"]);
  });

  it("puts the most urgent crew and person first", () => {
    const crews = crewsOnDuty(units, INCIDENT, 0);
    expect(crews.map((crew) => [crew.crew, crew.par.state])).toEqual([
      ["blue", "overdue"],
      ["red", "warning"],
    ]);
    expect(crews[1]?.people.map((one) => one.unit.unit_id)).toEqual(["c", "a"]);
  });

  it("is green for nobody while one of them was never confirmed", () => {
    const never = onDuty("z", "red", 950_000, { confirmed: "not_yet" });
    const red = [onDuty("a", "red", 900_000), never];
    expect(crewsOnDuty(red, INCIDENT, 0)[0]?.par).toEqual({ state: "unconfirmed", leftMs: 900_000 });
    expect(rollCall(red, INCIDENT, 0)).toMatchObject({ state: "unconfirmed", unconfirmed: 1 });
    expect(rollCall(red.slice(0, 1), INCIDENT, 0)).toMatchObject({ state: "green", unconfirmed: 0 });
  });

  it("counts who is overdue", () => {
    expect(rollCall(units, INCIDENT, 0)).toMatchObject({ overdue: 1, people: 3, leftMs: -1_000 });
  });

  it("is none where nobody is on duty", () => {
    expect(rollCall([unit("d")], INCIDENT, 0)).toBeNull();
  });
});

it("counts down like a kitchen clock", () => {
  expect([760_000, 1, 0, -5, 3_760_000].map(countdown)).toEqual([
    "12:40",
    "0:01",
    "0:00",
    "0:00",
    "1:02:40",
  ]);
});

it("promises no more time than is left", () => {
  expect([1_127_000, 119_900, 60_000, 59_999, 900, -5, 3_900_000].map(timeLeft)).toEqual([
    "18\u00a0min",
    "1\u00a0min",
    "1\u00a0min",
    "59\u00a0s",
    "0\u00a0s",
    "0\u00a0s",
    "1\u00a0h 05\u00a0min",
  ]);
});
