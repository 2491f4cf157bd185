import { describe, expect, it } from "vitest";
import { PATIENCE_MS, wayOut, type Standing } from "../src/live/failover";
import type { StandbyView } from "../src/wire";

const STANDBY: StandbyView = {
  station: "first",
  role: "active",
  url: "https://first:8443",
  other: "second",
  other_role: "standby",
  other_url: "https://second:8443",
  in_step: true,
};
const WELL: Standing = { link: { kind: "up" }, standby: STANDBY, led: true, nowMs: 10_000 };

function down(forMs: number): Standing["link"] {
  return { kind: "down", sinceMs: WELL.nowMs - forMs };
}

describe("the way to the other console", () => {
  it("is not taken while this station leads", () => {
    expect(wayOut(WELL)).toBeNull();
  });

  it("is taken when this station is gone, and not for a short break", () => {
    expect(wayOut({ ...WELL, link: down(PATIENCE_MS - 1) })).toBeNull();
    expect(wayOut({ ...WELL, link: down(PATIENCE_MS) })).toBe(STANDBY.other_url);
  });

  it("is taken when this station has become the standby", () => {
    const standby = { ...STANDBY, role: "standby", other_role: "active" };
    expect(wayOut({ ...WELL, standby })).toBe(STANDBY.other_url);
  });

  it("is not taken by who looks at a standby on purpose", () => {
    const standby = { ...STANDBY, role: "standby", other_role: "active" };
    expect(wayOut({ ...WELL, standby, led: false })).toBeNull();
  });

  it("leads to web pages only, and nowhere for the only station", () => {
    const standby = { ...STANDBY, other_url: "javascript:alert(1)" };
    expect(wayOut({ ...WELL, standby, link: down(PATIENCE_MS) })).toBeNull();
    expect(wayOut({ ...WELL, standby: null, link: down(PATIENCE_MS) })).toBeNull();
  });
});
