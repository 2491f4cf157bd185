import { signal } from "@preact/signals";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Picture } from "../src/live/picture";
import { followTrails, pastTrails, shownKinds } from "../src/plan/pastTrails";
import type { IncidentView } from "../src/wire";

interface Asked {
  incidentId: string;
  kind: string;
  answer: (unitId: string) => Promise<void>;
}

const asked: Asked[] = [];

vi.mock("../src/sessions", () => ({ attempt: <T>(work: Promise<T>) => work }));
vi.mock("../src/api", () => ({
  trails: (incidentId: string, kind: string) =>
    new Promise((resolve) => {
      asked.push({
        incidentId,
        kind,
        answer: async (unitId) => {
          resolve({ trails: [{ unit_id: unitId, points: [] }] });
          await new Promise((done) => setTimeout(done)); // what waits for it has gone on
        },
      });
    }),
}));

const follow = (incident_id: string, closed_ms: number | null = 1) =>
  followTrails({ incident: signal({ incident_id, closed_ms } as IncidentView) } as unknown as Picture);
const drawn = () => pastTrails.value.map(({ trails }) => [...trails.keys()].join());

describe("trails that are worked out", () => {
  beforeEach(() => {
    asked.length = 0;
    pastTrails.value = [];
    shownKinds.value = new Set(["smoothed"]);
  });
  afterEach(() => {
    shownKinds.value = new Set(["fused"]);
  });

  it("are drawn as soon as they are there", async () => {
    const end = follow("mill");
    await asked[0]?.answer("mill's");
    expect(asked.map((one) => one.incidentId)).toEqual(["mill"]);
    expect(drawn()).toEqual(["mill's"]);
    end();
  });

  it("come with what was shown at the time, as far back, so that they can be compared", () => {
    shownKinds.value = new Set(["fused", "raw", "smoothed"]);
    const end = follow("mill");
    expect(asked.map((one) => one.kind)).toEqual(["fused", "raw", "smoothed"]);
    shownKinds.value = new Set(["raw", "smoothed"]);
    expect(asked.slice(3).map((one) => one.kind)).toEqual(["raw", "smoothed"]);
    end();
  });

  it("are not asked for where only the last minutes of what is shown are wanted", () => {
    shownKinds.value = new Set(["fused"]);
    follow("mill")();
    expect(asked).toEqual([]);
  });

  it("are not drawn over another incident, neither those that were there nor those that come late", async () => {
    const end = follow("mill");
    await asked[0]?.answer("mill's");
    end();
    const endNext = follow("dock");
    expect(drawn()).toEqual([]);
    endNext();
    const endLast = follow("mill");
    await asked[1]?.answer("dock's");
    expect(drawn()).toEqual([]);
    await asked[2]?.answer("mill's");
    expect(drawn()).toEqual(["mill's"]);
    endLast();
  });

  it("of an open incident are asked for now and then, but not before the last answer", async () => {
    let passes = (): void => undefined;
    const window = { setInterval: (again: () => void) => ((passes = again), 1) };
    vi.stubGlobal("window", window);
    const end = follow("mill", null);
    passes();
    expect(asked.length).toBe(1);
    await asked[0]?.answer("mill's");
    passes();
    expect(asked.length).toBe(2);
    await asked[1]?.answer("mill's");
    end();
    vi.unstubAllGlobals();
  });
});
