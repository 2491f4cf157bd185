import { describe, expect, it } from "vitest";
import * as assessment from "../src/assessment";

const FIGURES: assessment.Figures = {
  ce50_m: 1.04,
  ce95_m: 2.26,
  ve50_m: 0.3,
  ve95_m: 0.8,
  se50_m: 1.2,
  se95_m: 2.5,
};

const UNIT: assessment.UnitAssessment = {
  unit_id: "FF-07",
  people: [],
  seconds: 60,
  walked_m: 40,
  stated: FIGURES,
  against_smoothed: FIGURES,
  floor_probability: null,
  floor_right: null,
  trust: { green_s: 30, amber_s: 20, red_s: 10, causes: [["not heard", 10]] },
  pin_residuals: [],
  loop_closure_m: null,
  loop_closure_percent: null,
  reentry_jumps_m: [],
  not_used: [],
};

const PIN: assessment.PinResidual = {
  pin_id: "p1",
  note: "",
  used: true,
  shown_m: 2.14,
  trail_m: 0.3,
  sigmas: 0.62,
  floor_right: true,
};

describe("the assessment of an incident", () => {
  it("calls people by their names, and a unit that nobody is known to have worn by its own", () => {
    expect(assessment.wearerOf(UNIT)).toBe("FF-07");
    expect(assessment.wearerOf({ ...UNIT, people: ["Mia", "Tom"] })).toBe("Mia, Tom (FF-07)");
  });

  it("says how long the light was which, as parts of the time", () => {
    expect(assessment.lightParts(UNIT.trust)).toEqual({ green: 0.5, amber: 1 / 3, red: 1 / 6 });
    expect(assessment.lightParts({ ...UNIT.trust, green_s: 0, amber_s: 0, red_s: 0 })).toBeNull();
  });

  it("says the errors under their headings, and that there are none", () => {
    expect(assessment.cells(FIGURES)).toEqual(["1.0\u00a0m", "2.3\u00a0m", "0.8\u00a0m", "2.5\u00a0m"]);
    expect(new Set(assessment.cells(null))).toEqual(new Set([assessment.NOTHING]));
  });

  it.each([
    [2.3, 5, true],
    [2.3, 3, false], // no worse than one would think
    [0.1, 0.4, false], // worse, but of no weight
    [5, 2.3, false],
  ])("holds %f m promised against %f m", (promised, known, tooSure) => {
    const of = (ce95_m: number) => ({ ...FIGURES, ce95_m });
    expect(assessment.tooSure(of(promised), of(known))).toBe(tooSure);
    expect(assessment.tooSure(null, of(known))).toBe(false);
    expect(assessment.tooSure(of(promised), null)).toBe(false);
  });

  it("says by how much the own path missed the beginning", () => {
    const looped = { ...UNIT, loop_closure_m: 1.23, loop_closure_percent: 3.04 };
    expect(assessment.closureOf(looped)).toBe("1.2\u00a0m (3.0\u00a0%)");
    expect(assessment.closureOf(UNIT)).toBe(assessment.NOTHING);
  });

  it("says every jump", () => {
    expect(assessment.jumpsOf({ ...UNIT, reentry_jumps_m: [4, 0.5] })).toBe("4.0\u00a0m, 0.5\u00a0m");
    expect(assessment.jumpsOf(UNIT)).toBe(assessment.NOTHING);
  });

  it("says how far a pin was off, and what was wrong besides", () => {
    expect(assessment.pinWords(PIN)).toBe("Pin: 2.1\u00a0m live, 0.3\u00a0m after post-processing (0.6 σ)");
    const wrong = { ...PIN, note: "Stairs", shown_m: null, used: false, floor_right: false };
    expect(assessment.pinWords(wrong)).toBe(
      "Stairs: not shown live, 0.3\u00a0m after post-processing (0.6 σ), wrong floor, not used",
    );
  });
});
