/** The roll call (PAR) as the screen needs it: who is due when, crew by crew.  Pure. */
import type { DutyView, IncidentView, UnitView } from "../wire";

export type ParState = "green" | "warning" | "overdue";

export interface Par {
  state: ParState;
  leftMs: number; // until the check-in is due; negative: overdue
}

export function parOf(duty: DutyView, incident: IncidentView | null, nowMs: number): Par {
  const leftMs = duty.due_ms - nowMs;
  const warningMs = (incident?.par_warning_s ?? 0) * 1000;
  return { state: leftMs <= 0 ? "overdue" : leftMs <= warningMs ? "warning" : "green", leftMs };
}

export interface OnDuty {
  unit: UnitView;
  duty: DutyView;
  par: Par;
}

export interface CrewOnDuty {
  crew: string;
  par: Par; // of whoever is due first
  people: OnDuty[]; // due first, first
}

/** Everybody who is to be heard from, crew by crew, the most urgent crew first. */
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
    .sort((a, b) => a.par.leftMs - b.par.leftMs || (a.crew < b.crew ? -1 : 1));
}

/** In one line: the next check-in that is due, and how many are over; null: nobody is on duty. */
export function rollCall(
  units: Iterable<UnitView>,
  incident: IncidentView | null,
  nowMs: number,
): (Par & { overdue: number; people: number }) | null {
  const all = crewsOnDuty(units, incident, nowMs);
  const first = all[0];
  if (first === undefined) return null;
  const people = all.flatMap((crew) => crew.people);
  const overdue = people.filter((one) => one.par.state === "overdue").length;
  return { ...first.par, overdue, people: people.length };
}

function byDue(a: OnDuty, b: OnDuty): number {
  return a.par.leftMs - b.par.leftMs || (a.unit.unit_id < b.unit.unit_id ? -1 : 1);
}

function earliest(people: readonly OnDuty[]): Par {
  return people.map((one) => one.par).reduce((a, b) => (b.leftMs < a.leftMs ? b : a));
}
