/** How good an incident's positions were, as the station assesses it and as people read it. Pure. */
import type * as answers from "./answers";

/** ISO/IEC 18305: circular, vertical and spherical error in metres, of 50 and of 95 %. */
export type Figures = answers.Figures;
export type PinResidual = answers.PinResidual;
export type TrustSeconds = answers.TrustReport;
export type UnitAssessment = answers.UnitReport;
export type Assessment = answers.IncidentReport;

/** The terms of the standard, in a few words. */
export const TERMS: readonly [string, string][] = [
  ["CE50, CE95", "circular error: half, or 95 %, of the places on the plan were no farther off"],
  ["VE95", "vertical error: 95 % of the heights were no farther off"],
  ["SE95", "spherical error: 95 % of the places in space were no farther off"],
];

export const NOTHING = "–";

/** Under CE50, CE95, VE95 and SE95. */
export function cells(figures: Figures | null): string[] {
  if (figures === null) return [NOTHING, NOTHING, NOTHING, NOTHING];
  const { ce50_m, ce95_m, ve95_m, se95_m } = figures;
  return [ce50_m, ce95_m, ve95_m, se95_m].map(metres);
}

/** The station promised clearly less error than there was; people relied on that. */
export function tooSure(stated: Figures | null, known: Figures | null): boolean {
  if (stated === null || known === null) return false;
  return known.ce95_m > MUCH_MORE * stated.ce95_m && known.ce95_m - stated.ce95_m > WORTH_SAYING_M;
}

const MUCH_MORE = 1.5;
const WORTH_SAYING_M = 1;

/** Who wore it, as people are called; the unit where nobody is known. */
export function wearerOf(unit: UnitAssessment): string {
  return unit.people.length === 0 ? unit.unit_id : `${unit.people.join(", ")} (${unit.unit_id})`;
}

/** Parts of the time in which the light was green, amber and red; null where none was seen. */
export function lightParts(trust: TrustSeconds): { green: number; amber: number; red: number } | null {
  const all = trust.green_s + trust.amber_s + trust.red_s;
  if (all <= 0) return null;
  return { green: trust.green_s / all, amber: trust.amber_s / all, red: trust.red_s / all };
}

/** How far the unit's own path missed where its wearer came back to the beginning. */
export function closureOf(unit: UnitAssessment): string {
  if (unit.loop_closure_m === null) return NOTHING;
  const share = unit.loop_closure_percent;
  return metres(unit.loop_closure_m) + (share === null ? "" : ` (${share.toFixed(1)} %)`);
}

export function jumpsOf(unit: UnitAssessment): string {
  return unit.reentry_jumps_m.map(metres).join(", ") || NOTHING;
}

/** "Stairs: 2.1 m then, 0.3 m since, wrong floor". */
export function pinWords(pin: PinResidual): string {
  const then = pin.shown_m === null ? "not shown then" : `${metres(pin.shown_m)} then`;
  const parts = [then, `${metres(pin.trail_m)} since (${pin.sigmas.toFixed(1)} σ)`];
  if (pin.floor_right === false) parts.push("wrong floor");
  if (!pin.used) parts.push("not used");
  return `${pin.note || "Pin"}: ${parts.join(", ")}`;
}

export function metres(value: number): string {
  return `${value.toFixed(1)}\u00a0m`;
}
