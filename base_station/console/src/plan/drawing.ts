/** A floor that is drawn on a picture or on empty paper: scaled by two points, walls by hand.  Pure. */
import type { Feature } from "geojson";
import type { Plan } from "../wire";
import type { FloorPicture } from "./planFile";

export interface Pixel {
  x: number; // from the left
  y: number; // from the top
}

/** Two points of the paper whose distance is known; up on the paper is north on the plan. */
export interface Scale {
  one: Pixel;
  other: Pixel;
  length_m: number;
  /** Where the first point lies on the plan. */
  east_m: number;
  north_m: number;
}

export type LineKind = "wall" | "outline" | "stairs";

export interface Line {
  kind: LineKind;
  points: readonly Pixel[];
}

export interface Paper {
  width_px: number;
  height_px: number;
  webp: string | null; // base64; null: empty paper
}

export interface DrawnFloor {
  floor: number;
  down_m: number;
  paper: Paper;
  scale: Scale;
  lines: readonly Line[];
}

/** Nearer than this, the points give no scale. */
export const LEAST_PX = 20;
const STOREY_M = 3.2;
const AROUND_M = 10;
const EMPTY_M = 60;
const EMPTY_PX = 1600;

export function metresPerPixel({ one, other, length_m }: Scale): number {
  return length_m / Math.hypot(other.x - one.x, other.y - one.y);
}

/** `[east_m, north_m]`. */
export function siteAt(scale: Scale, { x, y }: Pixel): [number, number] {
  const per = metresPerPixel(scale);
  return [scale.east_m + (x - scale.one.x) * per, scale.north_m - (y - scale.one.y) * per];
}

export function pixelAt(scale: Scale, [east_m = 0, north_m = 0]: readonly number[]): Pixel {
  const per = metresPerPixel(scale);
  return { x: scale.one.x + (east_m - scale.east_m) / per, y: scale.one.y - (north_m - scale.north_m) / per };
}

/** From the plan, or by default a storey above the floor below. */
export function downOf(plan: Plan | null, floor: number): number {
  const listed = plan?.muster.floors?.find((one) => one.floor === floor);
  return listed?.down_m ?? 0 - floor * STOREY_M;
}

/** Round the plan's lines, or 60 m by 60 m; with a scale. */
export function emptyPaper(plan: Plan | null): { paper: Paper; scale: Scale } {
  const ends = linesOf(plan, null).flatMap(({ line }) => line);
  const easts = ends.map(([east = 0]) => east);
  const norths = ends.map(([, north = 0]) => north);
  const half = EMPTY_M / 2;
  const west = ends.length === 0 ? -half : least(easts) - AROUND_M;
  const south = ends.length === 0 ? -half : least(norths) - AROUND_M;
  const width = ends.length === 0 ? EMPTY_M : most(easts) + AROUND_M - west;
  const height = ends.length === 0 ? EMPTY_M : most(norths) + AROUND_M - south;
  const per = Math.max(width, height) / EMPTY_PX;
  const [width_px, height_px] = [width / per, height / per];
  const below = { x: 0, y: height_px };
  return {
    paper: { width_px, height_px, webp: null },
    scale: { one: below, other: { x: width_px, y: height_px }, length_m: width, east_m: west, north_m: south },
  };
}

/** Lines that a plan has on a floor already (null: on all), in site metres. */
export function linesOf(plan: Plan | null, floor: number | null): { kind: string; line: number[][] }[] {
  return (plan?.features ?? []).flatMap(({ geometry, properties }) => {
    if (floor !== null && properties?.["floor"] !== floor) return [];
    const kind = String(properties?.["kind"] ?? "");
    switch (geometry?.type) {
      case "LineString":
        return [{ kind, line: geometry.coordinates }];
      case "Polygon":
      case "MultiLineString":
        return geometry.coordinates.map((line) => ({ kind, line }));
      case "MultiPolygon":
        return geometry.coordinates.flat().map((line) => ({ kind, line }));
      default:
        return [];
    }
  });
}

/** The plan with this floor drawn: its picture in place of the one before, its lines beside those
 * that are there. */
export function withFloor(plan: Plan | null, drawn: DrawnFloor, name: string): Plan {
  const { floor, down_m, paper, scale } = drawn;
  const floors = plan?.muster.floors ?? [];
  const isListed = floors.some((one) => one.floor === floor);
  const others = (plan?.muster.pictures ?? []).filter((one) => paper.webp === null || one.floor !== floor);
  const { damage: _, ...muster } = plan?.muster ?? { frame: "site-m" as const, name };
  return {
    type: "FeatureCollection",
    muster: {
      ...muster,
      floors: isListed ? floors : [...floors, { floor, down_m }],
      pictures: paper.webp === null ? others : [...others, pictureOf(paper, paper.webp, scale, floor)],
    },
    features: [...(plan?.features ?? []), ...drawn.lines.map((line) => featureOf(line, scale, floor))],
  };
}

function pictureOf(paper: Paper, webp: string, scale: Scale, floor: number): FloorPicture {
  return {
    floor,
    webp,
    upper_left_m: siteAt(scale, { x: 0, y: 0 }),
    upper_right_m: siteAt(scale, { x: paper.width_px, y: 0 }),
    lower_left_m: siteAt(scale, { x: 0, y: paper.height_px }),
  };
}

function featureOf({ kind, points }: Line, scale: Scale, floor: number): Feature {
  const line = points.map((point) => siteAt(scale, point).map(rounded));
  const properties = { kind, floor };
  if (kind === "wall") {
    return { type: "Feature", properties, geometry: { type: "LineString", coordinates: line } };
  }
  const ring = [...line, line[0] ?? []];
  return { type: "Feature", properties, geometry: { type: "Polygon", coordinates: [ring] } };
}

/** How many points a line needs: a wall two, what encloses something three. */
export function isComplete({ kind, points }: Line): boolean {
  return points.length >= (kind === "wall" ? 2 : 3);
}

function rounded(metres: number): number {
  return Math.round(metres * 1000) / 1000;
}

function least(values: readonly number[]): number {
  return values.reduce((one, other) => Math.min(one, other), Infinity);
}

function most(values: readonly number[]): number {
  return values.reduce((one, other) => Math.max(one, other), -Infinity);
}
