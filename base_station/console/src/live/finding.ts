/** Search and order of the list of members.  Pure. */
import type { UnitView } from "../wire";
import { onScene, partOf, type Part } from "./headcount";
import { displayName, isCasualty, type Place } from "./urgency";
import { compareNames } from "../language/measures";

export type Order = "need" | "crew" | "name";

export interface Sought {
  text: string; // of the search field
  part: Part | "on_scene" | null; // of the headcount; null: everybody
  always: string | null; // shown whatever is sought: who is chosen
}

/** Whether every word of the text begins a word of the name, the unit or the crew: "engine 2" is not
 * Engine 12. */
export function isFound(unit: UnitView, text: string): boolean {
  const { unit_id, label, person } = unit;
  const about = wordsOf([displayName(unit), unit_id, label, person?.crew ?? ""].join(" "));
  return wordsOf(text).every((word) => about.some((one) => one.startsWith(word)));
}

function wordsOf(text: string): string[] {
  return text.toLocaleLowerCase().split(/[^\p{L}\p{N}]+/u).filter((word) => word !== "");
}

/** Those places that are to be shown, in the order that they had; who is shown whatever is sought stands behind those
 * that were found, for the card of a chosen member may fill the list. */
export function sought(places: readonly Place[], units: readonly UnitView[], { text, part, always }: Sought): Place[] {
  if (text.trim() === "" && part === null) return [...places];
  const members = part === null ? units : onScene(units);
  const found = members
    .filter((unit) => part === null || part === "on_scene" || partOf(unit) === part)
    .filter((unit) => isFound(unit, text));
  const ids = new Set(found.map((unit) => unit.unit_id));
  const kept = places.filter(({ unitId }) => unitId === always && !ids.has(unitId));
  return [...places.filter(({ unitId }) => ids.has(unitId)), ...kept];
}

export interface Group {
  crew: string | null; // null: all in one list; "": without a crew
  places: readonly Place[];
  down: number; // of them
}

/** Sorted by urgency the order is kept; crews are sorted by name, members without a crew last. */
export function grouped(places: readonly Place[], units: readonly UnitView[], order: Order): Group[] {
  if (order === "name") return [groupOf(null, [...places].sort(byName))];
  if (order === "need") return [groupOf(null, places)];
  const crewOf = new Map(units.map((unit) => [unit.unit_id, unit.person?.crew ?? ""]));
  const crews = new Map<string, Place[]>();
  for (const place of places) {
    const crew = crewOf.get(place.unitId) ?? "";
    crews.set(crew, [...(crews.get(crew) ?? []), place]);
  }
  return [...crews]
    .sort(([a], [b]) => Number(a === "") - Number(b === "") || compareNames(a, b))
    .map(([crew, of]) => groupOf(crew, of));
}

function groupOf(crew: string | null, places: readonly Place[]): Group {
  return { crew, places, down: places.filter(isCasualty).length };
}

function byName(a: Place, b: Place): number {
  return compareNames(a.name, b.name) || (a.unitId < b.unitId ? -1 : 1);
}
