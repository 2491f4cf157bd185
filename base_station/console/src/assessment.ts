/** How good an incident's positions were, as the station assesses it and as people read it. Pure. */

/** ISO/IEC 18305: circular, vertical and spherical error in metres, of 50 and of 95 %. */
export interface Figures {
  ce50_m: number;
  ce95_m: number;
  ve50_m: number;
  ve95_m: number;
  se50_m: number;
  se95_m: number;
}

export interface PinResidual {
  pin_id: string;
  note: string;
  used: boolean;
  shown_m: number | null; // from what was shown then; null: nothing was shown, or no place is known
  trail_m: number; // from the trail as it is known since
  sigmas: number;
  floor_right: boolean | null;
}

/** For how long the light beside the name was which, and why it was not green. */
export interface TrustSeconds {
  green_s: number;
  amber_s: number;
  red_s: number;
  causes: [string, number][]; // longest first
}

export interface UnitAssessment {
  unit_id: string;
  people: string[]; // who wore it
  seconds: number;
  walked_m: number;
  stated: Figures | null; // as was promised at the time
  against_smoothed: Figures | null; // what was shown, against what is known since
  floor_probability: number | null; // as was promised at the time
  floor_right: number | null; // part of the time, by what is known since
  trust: TrustSeconds;
  pin_residuals: PinResidual[];
  loop_closure_m: number | null;
  loop_closure_percent: number | null; // of the way walked
  reentry_jumps_m: number[];
  not_used: [string, number][]; // fixes and sightings; by reason, most first
}

export interface Assessment {
  incident_id: string;
  made_ms: number;
  units: UnitAssessment[];
  stated: Figures | null; // over all units
  against_smoothed: Figures | null;
  is_newest: boolean; // else more of it is coming out of a journal, and is worked out soon
}

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
