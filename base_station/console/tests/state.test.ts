import { describe, expect, it } from "vitest";
import { apply, type State } from "../src/live/state";
import { TRAIL_POINTS } from "../src/live/thinning";
import type { Plan, Trail, TrailPoint } from "../src/wire";
import { alarm, command, delta, position, snapshot, unit } from "./fixtures";

function after(...messages: Parameters<typeof apply>[1][]): State {
  let state: State | null = null;
  for (const message of messages) state = apply(state, message).state;
  if (state === null) throw new Error("no snapshot among the messages");
  return state;
}

describe("apply", () => {
  it("takes a snapshot whole", () => {
    const state = after(snapshot({ units: [unit("a")], alarms: [alarm("x")] }));
    expect([...state.units.keys()]).toEqual(["a"]);
    expect([...state.alarms.keys()]).toEqual(["x"]);
  });

  it("replaces what a delta names and keeps the rest, as the same object", () => {
    const before = after(snapshot({ units: [unit("a"), unit("b")] }));
    const { state } = apply(before, delta(11, { units: [unit("b", { link: "stale" })] }));
    expect(state?.units.get("b")?.link).toBe("stale");
    expect(state?.units.get("a")).toBe(before.units.get("a"));
  });

  it("leaves everything as it was that a delta does not name", () => {
    const before = after(
      snapshot({ units: [unit("a")], alarms: [alarm("x")], commands: [command("c", { a: "sent" })] }),
      { type: "trail", unit_id: "a", points: [[1000, 0, 0, 0]] },
    );
    const { state } = apply(before, delta(11));
    expect(state).toEqual({ ...before, seq: 11, now_ms: 2_000 });
  });

  it("adds a unit that appears", () => {
    const state = after(snapshot(), delta(11, { units: [unit("new")] }));
    expect(state.units.has("new")).toBe(true);
  });

  it.each([9, 10, 12])("asks for a snapshot when %i comes after 10", (seq) => {
    const before = after(snapshot());
    const { state, missed } = apply(before, delta(seq, { units: [unit("a")] }));
    expect(missed).toBe(true);
    expect(state).toBe(before);
  });

  it("asks for a snapshot when a delta comes first", () => {
    expect(apply(null, delta(1))).toEqual({ state: null, missed: true });
  });

  it("goes on from the snapshot that closes a gap", () => {
    const state = after(snapshot(), snapshot({ seq: 40 }), delta(41, { units: [unit("a")] }));
    expect(state.seq).toBe(41);
  });

  it("keeps the plan as the same object while it is the same, so that nobody loses a part of it", () => {
    const plan = (name: string): Plan => ({
      type: "FeatureCollection",
      muster: { frame: "site-m", name },
      features: [],
    });
    const before = after(snapshot({ plan: plan("Mill") }));
    const again = apply(before, snapshot({ plan: plan("Mill") })).state;
    expect(again?.plan).toBe(before.plan);
    expect(apply(before, snapshot({ plan: plan("Yard") })).state?.plan).toEqual(plan("Yard"));
    expect(apply(before, snapshot({ plan: null })).state?.plan).toBeNull();
  });

  it("forgets a unit that a snapshot no longer has", () => {
    expect(after(snapshot({ units: [unit("a")] }), snapshot()).units.size).toBe(0);
  });

  it("follows how far a command gets with each unit", () => {
    const state = after(
      snapshot({ commands: [command("x", { a: "sent", b: "queued" })] }),
      delta(11, { commands: [command("x", { a: "acknowledged", b: "sent" })] }),
      delta(12, { commands: [command("y", { a: "queued" })] }),
    );
    expect([...state.commands.keys()]).toEqual(["x", "y"]);
    expect(state.commands.get("x")?.units.map((one) => one.state)).toEqual([
      "acknowledged",
      "sent",
    ]);
  });

  it("keeps open commands and the last closed ones", () => {
    const closed = Array.from({ length: 30 }, (_, i) => command(`c${i}`, {}, { open: false }));
    const open = command("open", { a: "sent" });
    const state = after(snapshot({ commands: [open] }), delta(11, { commands: closed }));
    expect(state.commands.has("open")).toBe(true);
    expect(state.commands.has("c29")).toBe(true);
    expect(state.commands.has("c0")).toBe(false);
  });

  it("keeps resolved alarms, but not without end", () => {
    const many = Array.from({ length: 80 }, (_, i) =>
      alarm(`r${i}`, { state: "resolved", changed_ms: i }),
    );
    const state = after(snapshot({ alarms: [alarm("open")] }), delta(11, { alarms: many }));
    expect(state.alarms.has("open")).toBe(true);
    expect(state.alarms.has("r79")).toBe(true);
    expect(state.alarms.has("r0")).toBe(false);
  });
});

describe("trails", () => {
  const walk = (seq: number, t_ms: number, north_m: number) =>
    delta(seq, { units: [unit("a", { position: position({ t_ms, north_m }) })] });
  const past = (unit_id: string, points: TrailPoint[]): Trail => ({ type: "trail", unit_id, points });
  const trail = (state: State) => state.trails.get("a")?.map((point) => point[0]);

  it("grow with the walk, a point a second at most", () => {
    const state = after(snapshot(), walk(11, 1000, 0), walk(12, 1400, 1), walk(13, 2000, 2));
    expect(trail(state)).toEqual([1000, 2000]);
  });

  it("grow half a metre at a time in any direction", () => {
    const to = (seq: number, t_ms: number, north_m: number, east_m: number) =>
      delta(seq, { units: [unit("a", { position: position({ t_ms, north_m, east_m }) })] });
    const state = after(
      snapshot(),
      to(11, 1000, -3, -4),
      to(12, 2000, -3.3, -4.3), // 0.42 m
      to(13, 3000, -3.5, -4),
      to(14, 4000, -3.5, -3.4),
    );
    expect(trail(state)).toEqual([1000, 3000, 4000]);
  });

  it("say seldom that somebody stands still", () => {
    const state = after(snapshot(), walk(11, 1000, 0), walk(12, 9000, 0), walk(13, 16000, 0));
    expect(trail(state)).toEqual([1000, 16000]);
  });

  it("say at once that somebody came to another floor", () => {
    const lift = (seq: number, t_ms: number, floor: number) =>
      delta(seq, { units: [unit("a", { position: position({ t_ms, floor }) })] });
    const state = after(snapshot(), lift(11, 1000, 0), lift(12, 1500, 1), lift(13, 2000, 1));
    expect(state.trails.get("a")?.map((point) => [point[0], point[3]])).toEqual([
      [1000, 0],
      [2000, 1],
    ]);
  });

  it("do not go back for a position from before", () => {
    const state = after(snapshot(), walk(11, 5000, 0), walk(12, 2000, 9));
    expect(trail(state)).toEqual([5000]);
  });

  it("are replaced whole where their past was filled in", () => {
    const filled: TrailPoint[] = [
      [1000, 0, 0, 0],
      [3000, 2, 0, 0],
      [5000, 4, 0, 0],
    ];
    const state = after(snapshot(), walk(11, 5000, 4), delta(12, { trails: { a: filled } }));
    expect(trail(state)).toEqual([1000, 3000, 5000]);
  });

  it("go on from what was before the snapshot, whatever was drawn meanwhile", () => {
    const before: TrailPoint[] = [
      [3000, 0, 0, 0],
      [5000, 2, 0, 0],
    ];
    const state = after(
      snapshot(),
      walk(11, 5500, 2.4),
      walk(12, 7000, 4),
      past("a", before),
      walk(13, 9000, 6),
    );
    expect(trail(state)).toEqual([3000, 5000, 7000, 9000]);
  });

  it("of a unit that says nothing are shown all the same", () => {
    const state = after(snapshot(), past("a", [[1000, 0, 0, 0]]));
    expect(trail(state)).toEqual([1000]);
    expect(state.seq).toBe(10);
    expect(apply(state, past("a", [])).missed).toBe(false);
  });

  it("from before another snapshot are gone with it", () => {
    expect(after(snapshot(), past("a", [[1000, 0, 0, 0]]), snapshot()).trails.size).toBe(0);
  });

  it("keep a bounded number of points, from the very first one on", () => {
    const long = Array.from({ length: TRAIL_POINTS }, (_, i): TrailPoint => [i * 1000, i, 0, 0]);
    const state = after(snapshot(), past("a", long), walk(11, 1e7, 1e4));
    expect(trail(state)?.length).toBeLessThanOrEqual(TRAIL_POINTS);
    expect(trail(state)?.[0]).toBe(0);
    expect(trail(state)?.at(-1)).toBe(1e7);
  });

  it("say where nothing was heard", () => {
    const state = after(snapshot(), walk(11, 1000, 0), walk(12, 2000, 1), walk(13, 23_000, 5));
    expect(state.trails.get("a")?.map((point) => point[4])).toEqual([undefined, undefined, 1]);
  });
});
