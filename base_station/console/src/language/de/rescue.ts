import type { Part } from "../catalogue";

export const route: Part<"route"> = {
  step: "{distance}",
  to_stairs: "{distance} bis zur Treppe",
  up: "{floors, plural, one {ein Geschoss} other {# Geschosse}} hinauf",
  down: "{floors, plural, one {ein Geschoss} other {# Geschosse}} hinunter",
  left: "links",
  right: "rechts",
  back: "umkehren",
  beside: "neben Ihnen",
  no_known_way: "kein bekannter Weg; {distance} Richtung {direction}",
  floor_unknown: "Geschoss unbekannt",
  crosses_walls: "{route}; eine Spur darauf führt durch eine Wand des Plans",
  length: "{distance} ± {uncertainty}",
  straight_line: "{length} Luftlinie",
};
