/** The assessment of an incident's positions, in words and usual units.  Pure. */
import { t } from "./language/translate";
import type * as answers from "./answers";
import { length, listed, number, quantity } from "./language/measures";

/** ISO/IEC 18305: circular, vertical and spherical error in metres, of 50 and of 95 %. */
export type Figures = answers.Figures;
export type PinResidual = answers.PinResidual;
export type TrustSeconds = answers.TrustReport;
export type UnitAssessment = answers.UnitReport;
export type Assessment = answers.IncidentReport;

/** The terms of the standard, and what each means. */
export const TERMS = [
  ["CE50, CE95", "assessment.ce"],
  ["VE95", "assessment.ve"],
  ["SE95", "assessment.se"],
] as const;

export const NOTHING = "–";

/** Under CE50, CE95, VE95 and SE95. */
export function cells(figures: Figures | null): string[] {
  if (figures === null) return [NOTHING, NOTHING, NOTHING, NOTHING];
  const { ce50_m, ce95_m, ve95_m, se95_m } = figures;
  return [ce50_m, ce95_m, ve95_m, se95_m].map((metres) => length(metres));
}

/** The stated error was clearly smaller than the actual one. */
export function tooSure(stated: Figures | null, known: Figures | null): boolean {
  if (stated === null || known === null) return false;
  return known.ce95_m > MUCH_MORE * stated.ce95_m && known.ce95_m - stated.ce95_m > WORTH_SAYING_M;
}

const MUCH_MORE = 1.5;
const WORTH_SAYING_M = 1;

/** Name of the wearer; the unit if there is none. */
export function wearerOf(unit: UnitAssessment): string {
  return unit.people.length === 0 ? unit.unit_id : `${unit.people.join(", ")} (${unit.unit_id})`;
}

/** Parts of the time in which the light was green, amber and red; null where none was seen. */
export function lightParts(trust: TrustSeconds): { green: number; amber: number; red: number } | null {
  const all = trust.green_s + trust.amber_s + trust.red_s;
  if (all <= 0) return null;
  return { green: trust.green_s / all, amber: trust.amber_s / all, red: trust.red_s / all };
}

/** Closure error of the unit's own path when its wearer returned to the start. */
export function closureOf(unit: UnitAssessment): string {
  if (unit.loop_closure_m === null) return NOTHING;
  const distance = length(unit.loop_closure_m);
  const percent = unit.loop_closure_percent;
  if (percent === null) return distance;
  return t("assessment.closure_share", { distance, share: quantity(percent, "percent", 1) });
}

export function jumpsOf(unit: UnitAssessment): string {
  return listed(unit.reentry_jumps_m.map((metres) => length(metres))) || NOTHING;
}

/** "Stairs: 2.1 m live, 0.3 m after post-processing, wrong floor". */
export function pinWords(pin: PinResidual): string {
  const live =
    pin.shown_m === null
      ? t("assessment.not_shown")
      : t("assessment.live", { distance: length(pin.shown_m) });
  const since = { distance: length(pin.trail_m), sigmas: number(pin.sigmas, 1) };
  const parts = [live, t("assessment.since", since)];
  if (pin.floor_right === false) parts.push(t("assessment.wrong_floor"));
  if (!pin.used) parts.push(t("assessment.unused"));
  return t("assessment.pin_words", { pin: pin.note || t("assessment.pin"), words: listed(parts) });
}
