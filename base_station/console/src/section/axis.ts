/** The axis along which a side section shows the building, and where what the plan draws lies on it.  Pure. */
import type { Geometry } from "geojson";
import type { Plan } from "../wire";

/** Along the longer side of the building, or along an axis of the site. */
export const AXES = ["longest", "east", "north"] as const;
export type AxisChoice = (typeof AXES)[number];

export interface Span {
  fromM: number;
  toM: number;
}

const STEP_DEG = 1;

/** Heading (clockwise from north) that points to the right of the section: eastward, or north where the
 * axis runs from south to north. */
export function axisHeadingRad(choice: AxisChoice, places: readonly number[][]): number {
  if (choice === "east") return Math.PI / 2;
  if (choice === "north") return 0;
  return longestHeadingRad(places);
}

/** Of the longer side of the smallest rectangle about all places; to the east where they have none. */
function longestHeadingRad(places: readonly number[][]): number {
  let [best, smallest] = [Math.PI / 2, Infinity];
  for (let degrees = 0; degrees < 90; degrees += STEP_DEG) {
    const heading = (degrees * Math.PI) / 180;
    const [across, along] = [lengthM(spanOf(places, heading)), lengthM(spanOf(places, heading + Math.PI / 2))];
    if (across * along >= smallest - 1e-6) continue;
    smallest = across * along;
    best = across > along ? heading : heading + Math.PI / 2;
  }
  return best > (3 * Math.PI) / 4 ? best - Math.PI : best;
}

export function alongM([east = 0, north = 0]: readonly number[], headingRad: number): number {
  return east * Math.sin(headingRad) + north * Math.cos(headingRad);
}

/** Null without a place. */
export function spanOf(places: readonly number[][], headingRad: number): Span | null {
  if (places.length === 0) return null;
  const [sin, cos] = [Math.sin(headingRad), Math.cos(headingRad)];
  let [fromM, toM] = [Infinity, -Infinity];
  for (const [east = 0, north = 0] of places) {
    const at = east * sin + north * cos;
    fromM = Math.min(fromM, at);
    toM = Math.max(toM, at);
  }
  return { fromM, toM };
}

export function united(spans: readonly (Span | null)[]): Span | null {
  const known = spans.filter((span) => span !== null);
  if (known.length === 0) return null;
  return {
    fromM: Math.min(...known.map(({ fromM }) => fromM)),
    toM: Math.max(...known.map(({ toM }) => toM)),
  };
}

function lengthM(span: Span | null): number {
  return span === null ? 0 : span.toM - span.fromM;
}

/** Corners of all that the plan draws, `[east_m, north_m]`. */
export function placesOf(plan: Plan | null): number[][] {
  return (plan?.features ?? []).flatMap(({ geometry }) => corners(geometry));
}

/** What the plan draws on each floor. */
export function floorSpans(plan: Plan | null, headingRad: number): Map<number, Span> {
  const spans = new Map<number, Span>();
  for (const { geometry, properties } of plan?.features ?? []) {
    const floor: unknown = properties?.["floor"];
    if (typeof floor !== "number") continue;
    const span = united([spans.get(floor) ?? null, spanOf(corners(geometry), headingRad)]);
    if (span !== null) spans.set(floor, span);
  }
  return spans;
}

export interface Stairs extends Span {
  floor: number; // from which they go up
}

export function stairsOf(plan: Plan | null, headingRad: number): Stairs[] {
  return (plan?.features ?? []).flatMap(({ geometry, properties }) => {
    const floor: unknown = properties?.["floor"];
    const span = spanOf(corners(geometry), headingRad);
    return properties?.["kind"] === "stairs" && typeof floor === "number" && span !== null
      ? [{ floor, ...span }]
      : [];
  });
}

/** What has no place (RFC 7946) has no corners. */
function corners(geometry: Geometry | null): number[][] {
  switch (geometry?.type) {
    case "LineString":
      return geometry.coordinates;
    case "Polygon":
    case "MultiLineString":
      return geometry.coordinates.flat();
    case "MultiPolygon":
      return geometry.coordinates.flat(2);
    default:
      return [];
  }
}
