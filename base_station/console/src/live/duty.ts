/** PAR for display: due times of members, crew by crew.  Pure. */
import type { DutyView, IncidentView, UnitView } from "../wire";
import { clockTime } from "../format";
import { t } from "../language/translate";
import { compareNames } from "../language/measures";

export type ParState = "green" | "unconfirmed" | "warning" | "overdue";

export interface Par {
  state: ParState;
  leftMs: number; // until the PAR is due; negative: overdue
}

export function parOf(duty: DutyView, incident: IncidentView | null, nowMs: number): Par {
  const leftMs = duty.due_ms - nowMs;
  const warningMs = (incident?.par_warning_s ?? 0) * 1000;
  if (leftMs <= 0) return { state: "overdue", leftMs };
  if (leftMs <= warningMs) return { state: "warning", leftMs };
  return { state: duty.confirmed === "not_yet" ? "unconfirmed" : "green", leftMs };
}

/** Last confirmation of the PAR: kind, time and user. */
export function confirmationWords({ confirmed, checked_in_ms, checked_in_by }: DutyView): string {
  if (checked_in_ms === null || confirmed === "not_yet") return t("confirmation.not_yet_confirmed");
  const time = clockTime(checked_in_ms);
  return confirmed === "self"
    ? t("confirmation.confirmed_by_unit", { time })
    : t("confirmation.confirmed_by_radio", { time, who: checked_in_by });
}

export interface OnDuty {
  unit: UnitView;
  duty: DutyView;
  par: Par;
}

export interface CrewOnDuty {
  crew: string;
  par: Par; // of whoever is due first; green only where everybody is confirmed
  people: OnDuty[]; // due first, first
}

/** Everybody whose PAR is to be confirmed, crew by crew, the most urgent crew first. */
export function crewsOnDuty(
  units: Iterable<UnitView>,
  incident: IncidentView | null,
  nowMs: number,
): CrewOnDuty[] {
  const crews = new Map<string, OnDuty[]>();
  for (const unit of units) {
    if (unit.duty === null) continue;
    const crew = unit.person?.crew ?? "";
    const one = { unit, duty: unit.duty, par: parOf(unit.duty, incident, nowMs) };
    crews.set(crew, [...(crews.get(crew) ?? []), one]);
  }
  return [...crews]
    .map(([crew, people]) => ({ crew, people: people.sort(byDue), par: earliest(people) }))
    .sort((a, b) => a.par.leftMs - b.par.leftMs || compareNames(a.crew, b.crew));
}

/** In one line: the next PAR that is due, how many are overdue, and how many not yet confirmed; null:
 * nobody is on duty. */
export function rollCall(
  units: Iterable<UnitView>,
  incident: IncidentView | null,
  nowMs: number,
): (Par & { overdue: number; unconfirmed: number; people: number }) | null {
  const all = crewsOnDuty(units, incident, nowMs);
  const first = all[0];
  if (first === undefined) return null;
  const people = all.flatMap((crew) => crew.people);
  const overdue = people.filter((one) => one.par.state === "overdue").length;
  const unconfirmed = people.filter((one) => one.duty.confirmed === "not_yet").length;
  return { ...earliest(people), overdue, unconfirmed, people: people.length };
}

function byDue(a: OnDuty, b: OnDuty): number {
  return a.par.leftMs - b.par.leftMs || (a.unit.unit_id < b.unit.unit_id ? -1 : 1);
}

function earliest(people: readonly OnDuty[]): Par {
  const first = people.map((one) => one.par).reduce((a, b) => (b.leftMs < a.leftMs ? b : a));
  const unconfirmed = people.some((one) => one.duty.confirmed === "not_yet");
  return first.state === "green" && unconfirmed ? { ...first, state: "unconfirmed" } : first;
}
