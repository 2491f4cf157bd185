/** Floors and the people on each.  Pure. */
import { urgencyOf } from "../live/urgency";
import type { FloorChoice } from "../uiState";
import type { AlarmView, Plan, PositionView, UnitView } from "../wire";
import { floorName, floorOf, isFloorLikely, shortFloor } from "../format";

export interface Floor {
  floor: number;
  name: string;
  people: number;
  endangered: number; // of them
}

/** Top floor first, as in a building: floors of the plan, floors with people, and the shown one, also
 * when it is empty. */
export function floorsOf(
  plan: Plan | null,
  units: readonly UnitView[],
  alarms: ReadonlyMap<string, AlarmView>,
  shown: FloorChoice = "all",
): Floor[] {
  const there = units.map((unit) => unit.position?.floor ?? null).filter((f) => f !== null);
  const lookedAt = shown === "all" ? [] : [shown];
  return [...new Set([...planFloors(plan), ...there, ...lookedAt])]
    .sort((a, b) => b - a)
    .map((floor) => {
      const on = units.filter((unit) => unit.position?.floor === floor);
      return {
        floor,
        name: shortFloor(floor),
        people: on.length,
        endangered: on.filter((unit) => urgencyOf(unit, alarms) === "immediate").length,
      };
    });
}

/** The initial floor: the one with most people, the lower one of equals. */
export function firstFloor(floors: readonly Floor[]): number | null {
  let best: Floor | null = null;
  for (const floor of floors) {
    if (best === null || floor.people >= best.people) best = floor;
  }
  return best?.floor ?? null;
}

/** The floor in addition to a mark: another than the shown one, or an unknown one; with all floors shown,
 * that of every mark. */
export function floorRemark(position: PositionView, shown: FloorChoice, old = false): string {
  if (!isFloorLikely(position)) return floorName(null);
  return position.floor === shown ? "" : floorOf(position, old);
}

/** Number of floors from the shown one up to the probable one of a person; 0: the same, or unknown. */
export function floorsUp(position: PositionView, shown: FloorChoice): number {
  if (shown === "all" || position.floor === null || !isFloorLikely(position)) return 0;
  return position.floor - shown;
}

/** Beside the mark of a person on another floor than the shown one: "▲2" is two floors up.  With all
 * floors shown, beside each mark: the floor, as on its button. */
export function floorBadge(position: PositionView, shown: FloorChoice): string {
  if (shown === "all") {
    return position.floor === null || !isFloorLikely(position) ? "?" : shortFloor(position.floor);
  }
  const up = floorsUp(position, shown);
  if (up === 0) return "";
  return up > 0 ? `▲${up}` : `▼${-up}`;
}

function planFloors(plan: Plan | null): Set<number> {
  const floors = new Set((plan?.muster.floors ?? []).map(({ floor }) => floor));
  for (const feature of plan?.features ?? []) {
    const floor: unknown = feature.properties?.["floor"];
    if (typeof floor === "number") floors.add(floor);
  }
  return floors;
}
