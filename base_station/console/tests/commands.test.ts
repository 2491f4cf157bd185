import { describe, expect, it } from "vitest";
import {
  answered,
  commandWord,
  crewsOf,
  current,
  newestFirst,
  openTo,
  progress,
  unansweredFirst,
} from "../src/live/commands";
import { command, unit } from "./fixtures";

const inCrew = (unitId: string, crew: string) =>
  unit(unitId, { person: { person_id: unitId, name: unitId, crew, role: "", photo_url: null } });

describe("commands", () => {
  it("shows a person what is open to that person", () => {
    const commands = [
      command("x", { a: "sent", b: "received" }),
      command("closed", { a: "acknowledged" }, { open: false }),
      command("y", { b: "queued" }),
    ];
    expect(openTo("b", commands).map((one) => [one.command.command_id, one.delivery.state])).toEqual(
      [
        ["x", "received"],
        ["y", "queued"],
      ],
    );
    expect(openTo("a", commands)).toHaveLength(1);
    expect(openTo("c", commands)).toEqual([]);
  });

  it("counts an answer only when it is the one that was asked for", () => {
    const units = { a: "acknowledged", b: "received", c: "sent" } as const;
    expect(answered(command("x", units))).toEqual([1, 3]);
    expect(answered(command("x", { b: "received" }, { asks_wearer: false }))).toEqual([1, 1]);
  });

  it("leaves the orders of a closed incident in it", () => {
    const incident = (closed_ms: number | null) => ({
      incident_id: "i2",
      name: "Dock",
      opened_ms: 0,
      closed_ms,
      par_interval_s: 1200,
      par_warning_s: 300,
      work_limit_s: 2400,
    });
    const done = { open: false };
    const commands = [
      command("of the last one", {}, { ...done, incident_id: "i1" }),
      command("of none", {}, done),
      command("of this one", {}, { ...done, incident_id: "i2" }),
      command("on its way", {}, { incident_id: "i1" }),
    ];
    const shown = (at: ReturnType<typeof incident> | null) =>
      current(commands, at).map((one) => one.command_id);
    expect(shown(incident(null))).toEqual(["of this one", "on its way"]);
    expect(shown(incident(5))).toEqual(["of none", "on its way"]);
    expect(shown(null)).toEqual(["of none", "on its way"]);
  });

  it("puts who has not answered first", () => {
    const order = command("x", { a: "acknowledged", b: "received", c: "acknowledged", d: "queued" });
    expect(unansweredFirst(order).map((one) => one.unit_id)).toEqual(["b", "d", "a", "c"]);
    expect(progress(order)).toBe("2 of 4 acknowledged");
    const locate = command("y", { a: "received", b: "queued" }, { kind: "locate", asks_wearer: false });
    expect(unansweredFirst(locate).map((one) => one.unit_id)).toEqual(["b", "a"]);
    expect(progress(locate)).toBe("1 of 2 received by the unit");
  });

  it("names each crew once, and nobody without one", () => {
    const units = [inCrew("a", "Red"), inCrew("b", "Blue"), inCrew("c", "Red"), inCrew("d", "")];
    expect(crewsOf([...units, unit("e")])).toEqual(["Blue", "Red"]);
  });

  it("says a message with its text", () => {
    expect(commandWord(command("x", {}))).toBe("Evacuate");
    expect(commandWord(command("x", {}, { kind: "text", text: "come out" }))).toBe(
      "Message: come out",
    );
  });

  it("puts the newest first", () => {
    const [old, young] = [command("o", {}), command("y", {}, { issued_ms: 5 })];
    expect(newestFirst([old, young])).toEqual([young, old]);
  });
});
