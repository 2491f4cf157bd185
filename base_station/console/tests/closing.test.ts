import { describe, expect, it } from "vitest";
import { inAlarm } from "../src/live/alarms";
import { unfinished } from "../src/live/closing";
import { alarm, unit } from "./fixtures";

const person = (name: string) => ({ person_id: name, name, crew: "", role: "", photo_url: null });
const fall = alarm("fall", { rule: "fall", unit_id: "FF-01", text: "Ana may have fallen" });
const heat = alarm("heat", { rule: "heat", unit_id: "FF-01", priority: 2, level: "warning", text: "Ana" });
const overdue = alarm("par", { rule: "missed-check-in", unit_id: "FF-01", text: "Ana" });
const own = alarm("disk", { rule: "station", unit_id: "" });
const over = alarm("over", { unit_id: "FF-02", state: "resolved" });
const units = [
  unit("FF-01", { person: person("Ana"), alarms: ["fall", "heat", "par"], inside_since_ms: 5 }),
  unit("FF-02", { person: person("Bo"), inside_since_ms: 5 }),
  unit("FF-03", { inside_since_ms: 5 }), // nobody wears it
  unit("FF-04", { person: person("Cy") }),
];

describe("an incident that is closed", () => {
  it("names alarms and who is inside, with the ids that the station wants", () => {
    const { words, ...despite } = unfinished(units, [fall, heat, own, over]);
    expect(words).toBe("Open alarms: Ana (Fall, Heat: warning). Inside: Ana; Bo.");
    expect(despite).toEqual({
      despite_alarm_ids: ["fall", "heat"],
      despite_unit_ids: ["FF-01", "FF-02"],
    });
  });

  it("has nothing to name where all is over", () => {
    expect(unfinished(units.slice(3), [own, over]).words).toBe("");
  });

  it("names a unit that is not listed by its id", () => {
    expect(unfinished([], [fall]).words).toBe("Open alarms: FF-01 (Fall).");
  });
});

it("asks about emergencies only, and not about the PAR itself", () => {
  const alarms = new Map([fall, heat, overdue].map((one) => [one.alarm_id, one]));
  expect(inAlarm(units, alarms)).toEqual(["Ana (Fall)"]);
});
