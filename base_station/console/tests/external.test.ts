import { describe, expect, it } from "vitest";
import { externalLabel, isStale } from "../src/plan/external";
import { externalMarker } from "./fixtures";

describe("a person of another team", () => {
  it("is named with the system that it is from", () => {
    expect(externalLabel(externalMarker(), 5_000)).toBe("Police 1 (county)");
  });

  it("is told with its age once it is old", () => {
    const marker = externalMarker({ t_ms: 1_000, stale_ms: 60_000 });
    expect(isStale(marker, 59_999)).toBe(false);
    expect(isStale(marker, 60_000)).toBe(true);
    expect(externalLabel(marker, 61_000)).toBe("Police 1 (county, 1\u00a0min 00\u00a0s ago)");
  });

  it("is named as an emergency where it is one", () => {
    const alert = externalMarker({ kind: "emergency" });
    expect(externalLabel(alert, 5_000)).toBe("EMERGENCY Police 1 (county)");
  });
});
