import { describe, expect, it } from "vitest";
import { answered, commandWord, crewsOf, newestFirst, openTo } from "../src/live/commands";
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
