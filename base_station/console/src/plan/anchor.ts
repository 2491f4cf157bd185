/** Georeference of the plan by two points of known latitude and longitude. Pure. */
import * as measures from "../language/measures";
import type { AnchorView } from "../wire";
import { t } from "../language/translate";
import type { Place } from "./tools";

export interface Known {
  place: Place;
  lat_deg: number;
  lon_deg: number;
}

export interface Fit {
  anchor: AnchorView;
  plan_m: number; // between the points on the plan
  earth_m: number; // and on the Earth
}

const RAD = Math.PI / 180;
const EQUATOR_M = 6_378_137.0; // WGS-84
const ECCENTRICITY_2 = 6.694_379_990_14e-3;
/** Scale error from which one of the two points must be wrong. */
const MOST_OFF = 0.05;

/** The anchor that maps the middle between the two points exactly; scale is not changed. */
export function anchorThrough(one: Known, other: Known, heightM: number): Fit {
  const midLat = (one.lat_deg + other.lat_deg) / 2;
  const midLon = (one.lon_deg + other.lon_deg) / 2;
  const perDegree = metresPerDegree(midLat);
  const earth = {
    north_m: (other.lat_deg - one.lat_deg) * perDegree.lat,
    east_m: (other.lon_deg - one.lon_deg) * perDegree.lon,
  };
  const plan = {
    north_m: other.place.north_m - one.place.north_m,
    east_m: other.place.east_m - one.place.east_m,
  };
  const turn = heading(earth) - heading(plan);
  const middle = turned(
    {
      north_m: (one.place.north_m + other.place.north_m) / 2,
      east_m: (one.place.east_m + other.place.east_m) / 2,
    },
    turn,
  );
  return {
    anchor: {
      lat_deg: midLat - middle.north_m / perDegree.lat,
      lon_deg: midLon - middle.east_m / perDegree.lon,
      height_m: heightM,
      plan_rotation_rad: Math.atan2(Math.sin(turn), Math.cos(turn)),
    },
    plan_m: length(plan),
    earth_m: length(earth),
  };
}

/** Position on the plan of a place on the Earth. */
export function siteOf(anchor: AnchorView, latDeg: number, lonDeg: number): Place {
  const perDegree = metresPerDegree((anchor.lat_deg + latDeg) / 2);
  const earth = {
    north_m: (latDeg - anchor.lat_deg) * perDegree.lat,
    east_m: (lonDeg - anchor.lon_deg) * perDegree.lon,
  };
  return turned(earth, -anchor.plan_rotation_rad);
}

/** Error of the two points; empty: none. */
export function doubtOf(fit: Fit): string {
  const apart = { plan: measures.length(fit.plan_m), earth: measures.length(fit.earth_m) };
  if (fit.plan_m < 5) return t("anchor.too_near", apart);
  const off = Math.abs(fit.earth_m / fit.plan_m - 1);
  return off > MOST_OFF ? t("anchor.wrong_point", apart) : "";
}

/** Effect of a new georeference, shown with the confirmation; empty: none. */
export function changeOf(shown: AnchorView, next: AnchorView): string {
  const moved = length(siteOf(next, shown.lat_deg, shown.lon_deg));
  const turn = next.plan_rotation_rad - shown.plan_rotation_rad;
  const turned = Math.abs(Math.atan2(Math.sin(turn), Math.cos(turn)) / RAD);
  const raised = Math.abs(next.height_m - shown.height_m);
  const people = movedWords(moved < LEAST_M ? "" : distance(moved), turned < LEAST_DEG ? "" : angle(turned));
  const height = raised < LEAST_M ? "" : t("anchor.height", { distance: distance(raised) });
  const [change, other] = [people, height].filter((words) => words !== "");
  if (change === undefined) return "";
  const place = placeWords(shown);
  return other === undefined ? t("anchor.change", { place, change }) : t("anchor.change_two", { place, change, other });
}

/** Effect on members positioned by satellites; empty: none. */
function movedWords(by: string, turn: string): string {
  if (by !== "" && turn !== "") return t("anchor.moves_and_turns", { distance: by, angle: turn });
  if (by !== "") return t("anchor.moves", { distance: by });
  return turn === "" ? "" : t("anchor.turns", { angle: turn });
}

/** "57.70000°, 11.97000°, its north towards 12.0°". */
export function placeWords({ lat_deg, lon_deg, plan_rotation_rad }: AnchorView): string {
  const heading = (plan_rotation_rad / RAD + 360) % 360;
  return t("anchor.place", { latitude: angle(lat_deg, 5), longitude: angle(lon_deg, 5), heading: angle(heading) });
}

const LEAST_M = 0.05;
const LEAST_DEG = 0.05;

function distance(metres: number): string {
  return metres >= 10_000 ? measures.far(metres) : measures.length(metres, metres < 100 ? 1 : 0);
}

function angle(degrees: number, digits = 1): string {
  return `${measures.number(degrees, digits)}°`;
}

function metresPerDegree(latDeg: number): { lat: number; lon: number } {
  const sin = Math.sin(latDeg * RAD);
  const bulge = 1 - ECCENTRICITY_2 * sin * sin;
  const meridian = (EQUATOR_M * (1 - ECCENTRICITY_2)) / bulge ** 1.5;
  return {
    lat: RAD * meridian,
    lon: RAD * (EQUATOR_M / Math.sqrt(bulge)) * Math.cos(latDeg * RAD),
  };
}

/** Clockwise from north. */
function heading(way: Place): number {
  return Math.atan2(way.east_m, way.north_m);
}

function turned({ north_m, east_m }: Place, turn: number): Place {
  const [sin, cos] = [Math.sin(turn), Math.cos(turn)];
  return { north_m: north_m * cos - east_m * sin, east_m: north_m * sin + east_m * cos };
}

function length(way: Place): number {
  return Math.hypot(way.north_m, way.east_m);
}
