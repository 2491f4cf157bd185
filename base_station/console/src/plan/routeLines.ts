/** A route as lines of `[east_m, north_m]`, one for each part on one floor.  Pure. */
import type { Route } from "../api";
import type { FloorChoice } from "../uiState";

export interface RouteLine {
  line: [number, number][];
  isHere: boolean; // on the floor that is shown
}

/** A stretch between two floors belongs to the floor that it comes from. */
export function routeLines({ places }: Pick<Route, "places">, floor: FloorChoice): RouteLine[] {
  const lines: (RouteLine & { on: number | null })[] = [];
  for (const { north_m, east_m, floor: on } of places) {
    const last = lines.at(-1);
    last?.line.push([east_m, north_m]);
    if (last === undefined || last.on !== on) {
      const isHere = floor === "all" || on === null || on === floor;
      lines.push({ on, isHere, line: [[east_m, north_m]] });
    }
  }
  return lines.filter(({ line }) => line.length > 1).map(({ line, isHere }) => ({ line, isHere }));
}
