import { describe, expect, it } from "vitest";
import {
  answered,
  commandWord,
  crewsOf,
  current,
  deliveryWord,
  lastLocate,
  mayAnswerByRadio,
  newestFirst,
  notNotifiable,
  openTo,
  progress,
  recipients,
  shownState,
  stands,
  unanswered,
  unansweredFirst,
} from "../src/live/commands";
import type { CommandView } from "../src/wire";
import { command, unit } from "./fixtures";

const inCrew = (unitId: string, crew: string) =>
  unit(unitId, { person: { person_id: unitId, name: unitId, crew, role: "", photo_url: null } });

/** The same where these units have no output. */
const without = (order: CommandView, ...unitIds: string[]): CommandView => ({
  ...order,
  units: order.units.map((one) =>
    unitIds.includes(one.unit_id) ? { ...one, can_be_notified: false } : one,
  ),
});

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
    const rate = { kind: "set_position_rate", asks_wearer: false, notifies_wearer: false };
    expect(answered(command("x", { b: "received" }, rate))).toEqual([1, 1]);
    const locate = { kind: "locate", asks_wearer: false };
    expect(answered(command("x", { a: "notified", b: "received" }, locate))).toEqual([1, 2]);
    expect(answered(command("x", { a: "notified" }))).toEqual([0, 1]);
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
      dispatch: null,
      site_id: "",
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

  it("takes an answer by radio for any signal, and asks for none where one was given", () => {
    const signals = { kind: "mayday_acknowledged", asks_wearer: false };
    const order = command("x", { a: "acknowledged", b: "received", c: "notified" }, signals);
    expect(unansweredFirst(order).map((one) => one.unit_id)).toEqual(["b", "a", "c"]);
    expect(progress(order)).toBe("2 of 3 signalled by the unit");
    expect(order.units.map((one) => mayAnswerByRadio(order, one))).toEqual([true, true, false]);
    const rate = { kind: "set_position_rate", asks_wearer: false, notifies_wearer: false };
    const [delivery] = order.units;
    expect(mayAnswerByRadio(command("y", {}, rate), delivery!)).toBe(false);
  });

  it("puts who has not answered first", () => {
    const order = command("x", { a: "acknowledged", b: "received", c: "acknowledged", d: "queued" });
    expect(unansweredFirst(order).map((one) => one.unit_id)).toEqual(["b", "d", "a", "c"]);
    expect(progress(order)).toBe("2 of 4 acknowledged");
    const locate = command("y", { a: "notified", b: "queued" }, { kind: "locate", asks_wearer: false });
    expect(unansweredFirst(locate).map((one) => one.unit_id)).toEqual(["b", "a"]);
    expect(progress(locate)).toBe("1 of 2 signalled by the unit");
  });

  it("counts as not reached, and puts first, whose unit has no output", () => {
    const states = { a: "sent", b: "received", c: "acknowledged", d: "queued", e: "expired" } as const;
    const order = without(command("x", states), "b", "c", "e");
    expect(order.units.map((one) => shownState(order, one))).toEqual([
      "sent",
      "cannot_be_notified",
      "acknowledged",
      "queued",
      "cannot_be_notified",
    ]);
    expect(unansweredFirst(order).map((one) => one.unit_id)).toEqual(["b", "e", "a", "d", "c"]);
    expect(progress(order)).toBe("1 of 5 acknowledged, 2 cannot be notified");
  });

  it("counts somebody as reached who answered by radio, or whose unit has signalled after all", () => {
    const order = without(command("x", { a: "acknowledged", b: "notified" }), "a", "b");
    expect(progress(order)).toBe("1 of 2 acknowledged");
  });

  it("says nothing of outputs where a unit has not described itself, or nobody is notified", () => {
    const order = command("x", { a: "received" });
    const [delivery] = order.units.map((one) => ({ ...one, can_be_notified: null }));
    expect(shownState(order, delivery!)).toBe("received");
    const rate = { kind: "set_position_rate", asks_wearer: false, notifies_wearer: false };
    expect(progress(without(command("x", { a: "received" }, rate), "a"))).toBe(
      "1 of 1 delivered",
    );
  });

  it("knows whom an order would go to", () => {
    const units = [
      inCrew("a", "Red"),
      inCrew("b", "Blue"),
      unit("spare"),
      unit("drawer", { switched_off: true }),
      unit("silent", { last_heard_ms: null }),
      unit("stranger", { registered: false }),
    ];
    const ids = (target: Parameters<typeof recipients>[0]) =>
      recipients(target, units).map((one) => one.unit_id);
    expect(ids({ everyone: true })).toEqual(["a", "b", "spare"]);
    expect(ids({ crew: "Red" })).toEqual(["a"]);
    expect(ids({ floor: 1 })).toEqual(["a", "b"]); // of both the floor is not known
    expect(ids({ unit_id: "drawer" })).toEqual(["drawer"]);
    expect(ids({ unit_id: "stranger" })).toEqual([]);
  });

  it("names before it is sent whom only the voice radio reaches", () => {
    const none = { can_be_notified: false };
    const units = [
      { ...inCrew("a", "Red"), ...none },
      { ...inCrew("b", "Red"), can_be_notified: null },
      { ...inCrew("c", "Blue"), ...none },
      inCrew("d", "Blue"),
    ];
    expect(notNotifiable({ everyone: true }, units)).toEqual({
      words: "2 of 4 cannot be notified: use the voice radio",
      names: ["a", "c"],
    });
    expect(notNotifiable({ crew: "Red" }, units)).toEqual({
      words: "1 of 2 cannot be notified: use the voice radio",
      names: ["a"],
    });
    expect(notNotifiable({ unit_id: "c" }, units)).toEqual({
      words: "1 of 1 cannot be notified: use the voice radio",
      names: ["c"],
    });
    expect(notNotifiable({ everyone: true }, [units[0]!, units[2]!])).toEqual({
      words: "2 of 2 cannot be notified: use the voice radio",
      names: [],
    });
    expect(notNotifiable({ unit_id: "d" }, units)).toBeNull();
    expect(notNotifiable({ unit_id: "b" }, units)).toBeNull();
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

describe("an evacuation", () => {
  const states = { a: "acknowledged", b: "received", c: "expired" } as const;

  it("stands until the all clear, answered by all or not", () => {
    expect(stands(command("x", { a: "acknowledged" }, { open: false }))).toBe(true);
    expect(stands(command("x", states, { ended_ms: 5 }))).toBe(false);
    expect(stands(command("x", states, { kind: "text" }))).toBe(false);
  });

  it("is sent again to those who have not answered, while it stands", () => {
    const waited = (order: CommandView) => unanswered(order).map((one) => one.unit_id);
    expect(waited(command("x", states))).toEqual(["b", "c"]);
    expect(waited(command("x", states, { ended_ms: 5 }))).toEqual([]);
    expect(waited(command("x", states, { kind: "locate", asks_wearer: false }))).toEqual([]);
  });

  it("is no missing answer once it has ended", () => {
    const ended = command("x", states, { ended_ms: 5, open: false });
    expect(ended.units.map((one) => shownState(ended, one))).toEqual([
      "acknowledged",
      "received",
      "ended",
    ]);
    expect(ended.units.map((one) => mayAnswerByRadio(ended, one))).not.toContain(true);
  });

  it("has an all clear that a unit of an earlier version does not know", () => {
    const clear = command("x", { a: "refused" }, { kind: "all_clear" });
    expect(clear.units.map((one) => shownState(clear, one))).toEqual(["cannot_be_notified"]);
  });
});

describe("the signal of a place", () => {
  const locate = { kind: "locate", asks_wearer: false };
  const words = (state: "received" | "notified" | "acknowledged", delivery: object, change: object = {}) => {
    const order = command("x", { a: state }, { ...locate, ...change });
    const [one] = order.units;
    return deliveryWord(order, { ...one!, sent_ms: 0, ...delivery });
  };

  it("says what the unit does, and who has stopped it", () => {
    expect(words("received", {})).toBe("delivered");
    expect(words("notified", { notified_ms: 0, signal: "sound" })).toMatch(/^sounds since /);
    expect(words("notified", { notified_ms: 0, signal: "light" })).toMatch(/^light since .*no sound/);
    expect(words("notified", { notified_ms: 0 })).toMatch(/^signals since /);
    expect(words("acknowledged", { acknowledged_ms: 0, acknowledged_via: "self" })).toMatch(
      /^stopped by the wearer /,
    );
    expect(words("received", { can_be_notified: false })).toBe("no sounder");
    const stopped = { open: false, ended_ms: 5 };
    expect(words("notified", { notified_ms: 0 }, stopped)).toBe("stopping …");
    expect(words("notified", { notified_ms: 0, ended_ms: 5 }, stopped)).toMatch(/^stopped /);
    expect(words("notified", { notified_ms: 0 }, { open: false })).toMatch(/^signalled until /);
  });

  it("is the last one that went to the unit", () => {
    const commands = [
      command("first", { a: "notified" }, { ...locate, issued_ms: 1 }),
      command("of another", { b: "notified" }, { ...locate, issued_ms: 3 }),
      command("last", { a: "sent", b: "sent" }, { ...locate, issued_ms: 2 }),
    ];
    expect(lastLocate("a", commands)?.command.command_id).toBe("last");
    expect(lastLocate("c", commands)).toBeNull();
  });
});
