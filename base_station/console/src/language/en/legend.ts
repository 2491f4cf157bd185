/** Legend of the plan. */

export const legend = {
  member: "Member: initials, with an arrow in the direction that they face.",
  warning: "Member with a warning: a square on its corner.",
  emergency: "Member in danger: an octagon with “!”.",
  chosen: "The chosen member: a border of another colour.",
  other_floor: "Hollow, with an arrow: on another floor, here two floors up.",
  region: "Area that holds the member with 95 % probability.",
  old: "Hatched, dashed and “?”: last known position, no signal since. The member may be anywhere in the area.",
  pin: "Pin: a member was here at a time. Hollow while it is not used yet.",
  pin_conflict: "Pin that contradicts the trail.",
} as const;
