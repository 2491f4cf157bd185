/** Data of one person for the side section.  Pure. */
import { initials, isFloorLikely } from "../format";
import { displayName, urgencyOf, type Urgency } from "../live/urgency";
import { isOld } from "../plan/ellipse";
import type { AlarmView, PositionView, UnitView } from "../wire";
import { alongM } from "./axis";

/** Of a normal distribution: 95 % lie within so many standard deviations. */
const SIGMAS_95 = 1.96;

export interface Member {
  unitId: string;
  name: string;
  initials: string;
  urgency: Urgency;
  chosen: boolean;
  old: boolean;
  floor: number | null; // null: nobody knows it
  alongM: number;
  heightM: number; // above the origin of the site
  errorM: number; // of the height, with 95 %
  position: PositionView;
}

export interface Scene {
  units: readonly UnitView[];
  alarms: ReadonlyMap<string, AlarmView>;
  nowMs: number;
  chosen: string | null;
}

/** All people with a position, by unit: their order does not change as they walk. */
export function membersOf(scene: Scene, headingRad: number): Member[] {
  return scene.units
    .flatMap((unit) => (unit.position === null ? [] : [memberOf(unit, unit.position, scene, headingRad)]))
    .sort((a, b) => (a.unitId < b.unitId ? -1 : 1));
}

function memberOf(unit: UnitView, position: PositionView, scene: Scene, headingRad: number): Member {
  const name = displayName(unit);
  return {
    unitId: unit.unit_id,
    name,
    initials: initials(name),
    urgency: urgencyOf(unit, scene.alarms),
    chosen: unit.unit_id === scene.chosen,
    old: isOld(position, scene.nowMs) || position.reach.length > 0,
    floor: isFloorLikely(position) ? position.floor : null,
    alongM: alongM([position.east_m, position.north_m], headingRad),
    heightM: 0 - position.down_m,
    errorM: SIGMAS_95 * position.std_down_m,
    position,
  };
}

/** Has a mark of their own while there is room. */
export function isAlone({ chosen, urgency }: Pick<Member, "chosen" | "urgency">): boolean {
  return chosen || urgency === "immediate" || urgency === "soon";
}

/** Always named. */
export function isStrong({ chosen, urgency }: Pick<Member, "chosen" | "urgency">): boolean {
  return chosen || urgency === "immediate";
}
