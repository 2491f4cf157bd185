/** The way to a member who is down. */
export const route = {
  step: "{distance}",
  to_stairs: "{distance} to the stairs",
  up: "up {floors, plural, one {one floor} other {# floors}}",
  down: "down {floors, plural, one {one floor} other {# floors}}",
  left: "left",
  right: "right",
  back: "turn back",
  beside: "beside you",
  no_known_way: "no known way; {distance} to the {direction}",
  floor_unknown: "floor unknown",
  crosses_walls: "{route}; a trail on it leads through a wall of the plan",
  length: "{distance} ± {uncertainty}",
  straight_line: "{length} in a straight line",
} as const;
