/** A route in words, from its legs: "14 m to the stairs, up one floor, left, 9 m".  Pure. */
import type { Route } from "../api";
import { length, listed } from "../language/measures";
import { t } from "../language/translate";
import { compassWord } from "../plan/edges";

type Leg = Route["legs"][number];

/** Shorter legs are not described (base_station/routing/legs.py). */
const SHORTEST_M = 1.5;

export function routeText({ known, legs, places }: Route): string {
  if (!known) return lineText(places);
  return listed(legs.flatMap(legWords)) || t("route.beside");
}

function legWords(leg: Leg): string[] {
  const words: string[] = [];
  if (leg.distance_m >= SHORTEST_M) {
    const distance = distanceText(leg.distance_m);
    if (leg.turn === null) words.push(compassWord(leg.bearing_rad));
    else if (leg.turn !== "ahead") words.push(t(`route.${leg.turn}`));
    words.push(leg.floors === 0 ? distance : t("route.to_stairs", { distance }));
  }
  return leg.floors === 0 ? words : [...words, climb(leg.floors)];
}

/** Without a known route: the distance and direction of a straight line. */
function lineText(places: Route["places"]): string {
  const [begin, end] = [places[0], places.at(-1)];
  if (begin === undefined || end === undefined) return "";
  const [north, east] = [end.north_m - begin.north_m, end.east_m - begin.east_m];
  const direction = compassWord(Math.atan2(east, north));
  const way = t("route.no_known_way", { distance: distanceText(Math.hypot(north, east)), direction });
  if (begin.floor === null || end.floor === null) return listed([way, t("route.floor_unknown")]);
  return end.floor === begin.floor ? way : listed([way, climb(end.floor - begin.floor)]);
}

function climb(floors: number): string {
  return floors > 0 ? t("route.up", { floors }) : t("route.down", { floors: -floors });
}

function distanceText(metres: number): string {
  return length(Math.max(1, metres), 0);
}
