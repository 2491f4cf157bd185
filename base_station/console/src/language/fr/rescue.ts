import type { Part } from "../catalogue";

export const route: Part<"route"> = {
  step: "{distance}",
  to_stairs: "{distance} jusqu’à l’escalier",
  up: "monter {floors, plural, one {d’un étage} other {de # étages}}",
  down: "descendre {floors, plural, one {d’un étage} other {de # étages}}",
  left: "à gauche",
  right: "à droite",
  back: "faire demi-tour",
  beside: "à côté de vous",
  no_known_way: "pas de chemin connu\u00a0; {distance} vers {direction}",
  floor_unknown: "étage inconnu",
  crosses_walls: "{route}\u00a0; une trace y traverse un mur du plan",
  length: "{distance} ± {uncertainty}",
  straight_line: "{length} à vol d’oiseau",
};
