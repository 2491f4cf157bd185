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

/** Top floor first, as in a building: those of the plan, those where somebody is, and the one that is
 * looked at, also when the last one has left it. */
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

/** The floor to begin with: where most people are, the lower one of equals. */
export function firstFloor(floors: readonly Floor[]): number | null {
  let best: Floor | null = null;
  for (const floor of floors) {
    if (best === null || floor.people >= best.people) best = floor;
  }
  return best?.floor ?? null;
}

/** What the drawing does not say of somebody: another floor than the one shown, or one that nobody knows;
 * where all floors are shown, each one's. */
export function floorRemark(position: PositionView, shown: FloorChoice, old = false): string {
  if (!isFloorLikely(position)) return floorName(null);
  return position.floor === shown ? "" : floorOf(position, old);
}

/** From the floor shown up to the one where somebody probably is; 0: the same, or nobody knows. */
export function floorsUp(position: PositionView, shown: FloorChoice): number {
  if (shown === "all" || position.floor === null || !isFloorLikely(position)) return 0;
  return position.floor - shown;
}

/** Beside the mark of somebody on another floor than the one shown: "▲2" is two floors up.  Where all
 * floors are shown, beside each mark: the floor, as on its button. */
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
