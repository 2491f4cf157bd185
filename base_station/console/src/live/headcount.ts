/** The headcount: every member on scene is in exactly one part of it, so that the counts add up.  Pure. */
import type { UnitView } from "../wire";
import { recipients } from "./commands";

export const PARTS = ["inside", "outside", "rehab", "not_located", "never_heard"] as const;
export type Part = (typeof PARTS)[number];

export interface Headcount {
  onScene: number;
  parts: Readonly<Record<Part, number>>;
}

/** Members with a unit, and units in use without a wearer: the recipients of an order to everyone. */
export function onScene(units: readonly UnitView[]): UnitView[] {
  return recipients({ everyone: true }, units);
}

/** Not located: no message in this incident, no position yet, or switched off while inside.  A member
 * inside counts as inside, whatever status was entered. */
export function partOf(unit: UnitView): Part {
  const inside = unit.inside_since_ms !== null;
  if (unit.link === "never") return "never_heard";
  if (unit.position === null || unit.duty?.located === false) return "not_located";
  if (inside) return unit.switched_off ? "not_located" : "inside";
  return unit.duty !== null && unit.duty.rest_since_ms !== null ? "rehab" : "outside";
}

export function headcountOf(units: readonly UnitView[]): Headcount {
  const parts = { inside: 0, outside: 0, rehab: 0, not_located: 0, never_heard: 0 };
  const members = onScene(units);
  for (const unit of members) parts[partOf(unit)] += 1;
  return { onScene: members.length, parts };
}
