/** Trails and the route to a member, in three dimensions.  Pure. */
import type { Route } from "../api";
import { urgencyOf, type Urgency } from "../live/urgency";
import { joinedAsSaid } from "../plan/trail";
import type { Level } from "../section/levels";
import type { Scene } from "../section/members";
import type { TrailPoint } from "../wire";
import type { Place3 } from "./building";

export interface StackedPath {
  places: readonly Place3[];
  urgency: Urgency;
  chosen: boolean;
}

/** The complete trails of the chosen member and of members in danger; those of all would hide the floors. */
export function stackedTrails(
  scene: Scene,
  trails: ReadonlyMap<string, readonly TrailPoint[]>,
  levels: readonly Level[],
): StackedPath[] {
  const heightsM = new Map(levels.map(({ floor, heightM }) => [floor, heightM]));
  return scene.units.flatMap((unit) => {
    const urgency = urgencyOf(unit, scene.alarms);
    const chosen = unit.unit_id === scene.chosen;
    if (!chosen && urgency !== "immediate") return [];
    return trailPaths(trails.get(unit.unit_id) ?? [], heightsM).map((places) => ({ places, urgency, chosen }));
  });
}

/** Broken where nothing was received.  A trail has floors, not heights; a point without one is on the
 * floor of the point before it. */
function trailPaths(points: readonly TrailPoint[], heightsM: ReadonlyMap<number, number>): Place3[][] {
  const paths: Place3[][] = [];
  let heightM = points.map(([, , , floor]) => heightsM.get(floor ?? NaN)).find((one) => one !== undefined) ?? 0;
  points.forEach((point, i) => {
    const [, northM, eastM, floor] = point;
    heightM = heightsM.get(floor ?? NaN) ?? heightM;
    const before = points[i - 1];
    const place: Place3 = [eastM, northM, heightM];
    if (before !== undefined && joinedAsSaid(before, point)) paths.at(-1)?.push(place);
    else paths.push([place]);
  });
  return paths.filter((path) => path.length > 1);
}

export function stackedRoute({ places }: Pick<Route, "places">, levels: readonly Level[]): Place3[] {
  const heightsM = new Map(levels.map(({ floor, heightM }) => [floor, heightM]));
  let heightM = 0;
  return places.map(({ east_m, north_m, floor }) => {
    heightM = heightsM.get(floor ?? NaN) ?? heightM;
    return [east_m, north_m, heightM];
  });
}
