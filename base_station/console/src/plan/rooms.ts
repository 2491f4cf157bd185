/** The room of a person on the plan, as far as it is certain.  Pure. */
import type { Geometry } from "geojson";
import type { Plan, PositionView } from "../wire";
import { t } from "../language/translate";
import { ring, type Region } from "./ellipse";
import { siteCoordinate } from "./site";

/** A region wider than this is in no room. */
const WIDEST_M = 10;
const FLOOR_CERTAIN = 0.95;

/** "in store" if all of the region is in the room, "near store" if only its middle is; empty if plan,
 * floor or position are not known well enough. */
export function roomWord(plan: Plan | null, position: PositionView, region: Region): string {
  if (plan === null || position.floor === null || region.major_m > WIDEST_M) return "";
  if ((position.floor_probability ?? 1) < FLOOR_CERTAIN) return "";
  const centre = siteCoordinate(position);
  const room = plan.features.find(
    ({ properties, geometry }) =>
      properties?.["kind"] === "room" &&
      properties["floor"] === position.floor &&
      holds(geometry, centre),
  );
  const name: unknown = room?.properties?.["name"];
  if (room === undefined || typeof name !== "string" || name === "") return "";
  const whole = ring(centre, region).every((at) => holds(room.geometry, at));
  return t(whole ? "plan.in_room" : "plan.near_room", { room: name });
}

/** Whether a point is in an area, by counting the borders east of it, which includes holes.  A feature
 * without geometry (RFC 7946) contains no point. */
function holds(area: Geometry | null, at: readonly [number, number]): boolean {
  return area !== null && ringsOf(area).filter((border) => isInside(border, at)).length % 2 === 1;
}

function ringsOf(area: Geometry): number[][][] {
  if (area.type === "Polygon") return area.coordinates;
  return area.type === "MultiPolygon" ? area.coordinates.flat() : [];
}

function isInside(border: readonly number[][], [east, north]: readonly [number, number]): boolean {
  let inside = false;
  border.forEach(([x2 = 0, y2 = 0], i) => {
    const [x1 = 0, y1 = 0] = border.at(i - 1) ?? [];
    const crosses = y1 > north !== y2 > north;
    if (crosses && east < x1 + ((north - y1) / (y2 - y1)) * (x2 - x1)) inside = !inside;
  });
  return inside;
}
