/** Urgency of members, and a list whose order is stable while it is read.  Pure. */
import type { AlarmView, UnitView } from "../wire";
import { MISSED_CHECK_IN, SWITCHED_OFF } from "../format";
import { compareNames } from "../language/measures";

export type Urgency = "immediate" | "soon" | "watch" | "normal";

const RANK: Record<Urgency, number> = { immediate: 2, soon: 3, watch: 4, normal: 5 };
const MAYDAY = 0;
const IN_NEED = 1; // by more than a roll call that nobody has answered yet
const CALMING_MS = 10_000;

/** From the unit's open alarms, its state, and its link; a unit that was switched off normally is not
 * missed, and the notice of that is not urgent. */
export function urgencyOf(unit: UnitView, alarms: ReadonlyMap<string, AlarmView>): Urgency {
  const open = unit.alarms.map((id) => alarms.get(id));
  const priorities = open.filter((one) => !saysSwitchedOff(one)).map((one) => one?.priority ?? 1);
  const link = unit.switched_off ? "live" : unit.link;
  if (unit.status?.mayday || priorities.includes(1)) return "immediate";
  if (priorities.includes(2) || link === "lost") return "soon";
  const watched = priorities.length > 0 || link === "stale" || unit.heat_level !== "";
  return watched ? "watch" : "normal";
}

function saysSwitchedOff(alarm: AlarmView | undefined): boolean {
  return alarm?.level === SWITCHED_OFF;
}

/** Rank of the unit in the list: a mayday first, a unit that is only not received last. */
function rankOf(unit: UnitView, alarms: ReadonlyMap<string, AlarmView>): number {
  const urgency = urgencyOf(unit, alarms);
  if (urgency !== "immediate") return RANK[urgency];
  const open = unit.alarms.map((id) => alarms.get(id));
  if (unit.status?.mayday || open.some((one) => one?.rule === "mayday")) return MAYDAY;
  const inNeed = open.some((one) => (one?.priority ?? 1) === 1 && one?.rule !== MISSED_CHECK_IN);
  return inNeed ? IN_NEED : RANK.immediate;
}

export function displayName(unit: UnitView): string {
  return unit.person?.name ?? (unit.label || unit.unit_id);
}

/** Label in a choice of several members: members of the same name are distinguished by the unit. */
export function nameAmong(unit: UnitView, units: readonly UnitView[]): string {
  const name = displayName(unit);
  const namesakes = units.filter((one) => displayName(one) === name);
  return namesakes.length > 1 ? `${name} (${unit.unit_id})` : name;
}

/** Whether a member is a casualty: in need of help, and not only overdue. */
export function isCasualty({ rank }: Place): boolean {
  return rank <= IN_NEED;
}

/** Rank of a unit in the list, and the time since which a lower rank would be due. */
export interface Place {
  unitId: string;
  name: string;
  urgency: Urgency;
  rank: number; // the lower, the further up
  calmSinceMs: number | null;
}

/** A longer or negative step of time between two updates is a seek in a replay: the previous order is
 * discarded. */
const JUMP_MS = 5_000;

export function isJump(beforeMs: number, nowMs: number): boolean {
  return nowMs < beforeMs || nowMs - beforeMs > JUMP_MS;
}

/** The list after a change.  A member whose state gets worse moves up at once; one whose state improves
 * keeps the place for a while; while `held` (the pointer moves over the list) only the former move. */
export function arrange(
  before: readonly Place[],
  units: readonly UnitView[],
  alarms: ReadonlyMap<string, AlarmView>,
  nowMs: number,
  held: boolean,
): Place[] {
  const known = new Map(before.map((place) => [place.unitId, place]));
  const places = units.map((unit) => {
    try {
      return placeOf(unit, alarms, known.get(unit.unit_id), nowMs, held);
    } catch {
      return firstOfAll(unit.unit_id); // the card says what is wrong
    }
  });
  return places.sort(
    (a, b) =>
      a.rank - b.rank || compareNames(a.name, b.name) || (a.unitId < b.unitId ? -1 : 1),
  );
}

/** Members whose state is unknown. */
function firstOfAll(unitId: string): Place {
  return { unitId, name: unitId, urgency: "immediate", rank: MAYDAY, calmSinceMs: null };
}

function placeOf(
  unit: UnitView,
  alarms: ReadonlyMap<string, AlarmView>,
  before: Place | undefined,
  nowMs: number,
  held: boolean,
): Place {
  const urgency = urgencyOf(unit, alarms);
  const rank = rankOf(unit, alarms);
  const name = String(displayName(unit)); // else one odd name would leave nobody in order
  const place = { unitId: unit.unit_id, name, urgency, rank, calmSinceMs: null };
  if (before === undefined || rank <= before.rank) return place;
  const calmSinceMs = before.calmSinceMs ?? nowMs;
  if (!held && nowMs - calmSinceMs >= CALMING_MS) return place;
  return { ...place, urgency: before.urgency, rank: before.rank, calmSinceMs };
}

export function samePlaces(a: readonly Place[], b: readonly Place[]): boolean {
  return a.length === b.length && a.every((place, i) => samePlace(place, b[i]));
}

function samePlace(a: Place, b: Place | undefined): boolean {
  return a.unitId === b?.unitId && a.urgency === b.urgency && a.rank === b.rank && a.calmSinceMs === b.calmSinceMs;
}
