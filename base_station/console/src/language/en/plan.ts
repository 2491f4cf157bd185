/** The plan: its place, content and display. */
export const anchor = {
  title: "Plan location",
  align: "Align by two points",
  first_point: "First point",
  second_point: "Second point",
  point: "{point}: {where}",
  click: "click on the plan",
  latitude: "Latitude, °",
  hint: "Take two corners far apart. A map or a GPS receiver tells where they are.",
  hint_map: "Take two corners far apart. Click the same two, in the same order, on the plan and on the map.",
  save: "Save location",
  too_near:
    "The points are {plan} apart on the plan and {earth} on the Earth: take two that are farther apart.",
  wrong_point:
    "The points are {plan} apart on the plan and {earth} on the Earth: one of them is another point, or the plan's scale is wrong.",
  moves: "on the plan, whoever satellites have placed moves by {distance}",
  turns: "on the plan, whoever satellites have placed is turned by {angle}",
  moves_and_turns: "on the plan, whoever satellites have placed moves by {distance} and is turned by {angle}",
  height: "its height changes by {distance}",
  change: "The plan has a place: {place}. With the new one, {change}.",
  change_two: "The plan has a place: {place}. With the new one, {change}, and {other}.",
  place: "{latitude}, {longitude}, its north towards {heading}",
} as const;

export const base_map = {
  done: "The base map is set.",
  none: "There is none.",
  some: "There is one.",
  not_world_file: "A world file has six numbers, one a line.",
  picture: "Picture (PNG, JPEG or WebP)",
  world_file: "World file (.pgw, .jgw, .tfw or .wld)",
  epsg: "EPSG number (empty: degrees or web map)",
  set: "Set base map",
  remove: "Remove base map",
  remove_question: "Remove the map for everybody?",
} as const;

export const beacon = {
  title: "Beacon",
  new: "A beacon hangs here",
  number: "Its number",
  not_passed: "No unit has passed it yet.",
  passed: "A unit passed it {age} ago.",
  reach: "Noticed from, {unit}",
  place: "Place beacon",
  save: "Save beacon",
  remove: "Remove beacon",
  remove_question: "Nobody who passes it is placed by it any more.",
} as const;

export const plan = {
  contents:
    "{name}: {floors, plural, one {# floor} other {# floors}}, {rooms, plural, one {# room} other {# rooms}}, {shapes, plural, one {# shape} other {# shapes}}",
  unnamed: "unnamed plan",
  in_room: "in {room}",
  near_room: "near {room}",
  feature: "Feature {number} of the plan",
  floor_picture: "The picture of this floor",
  unit: "{unit} on the plan",
  colours: "The colours of the plan",
  scale: "The scale of the plan",
  building: "The building",
  pins: "The pins on the plan",
  trails: "The trails on the plan",
  way: "The way on the plan",
  others: "Other teams on the plan",
  paper: "Paper: arrow keys move the cross, Enter sets a point",
  outside_view: "In danger, outside the view",
  show: "Show {name}",
  show_outside: "Show {name}, outside the view to the {direction}",
  floor_shown: "Floor shown",
  all_floors: "All",
  floor_label: "Floor {floor},",
  floors_label: "Floors: {floor},",
  in_danger_of: "in danger, of",
  people: "{count, plural, one {person} other {people}}",
} as const;

export const compass = {
  n: "north",
  ne: "north-east",
  e: "east",
  se: "south-east",
  s: "south",
  sw: "south-west",
  w: "west",
  nw: "north-west",
} as const;

export const trail = {
  fused: "Live track",
  raw: "Dead-reckoning only",
  smoothed: "Post-processed",
  title: "Trails",
  loading: "is worked out …",
  hint_all: "The last five minutes. Choose a person to compare all of that person’s.",
  hint_chosen: "The chosen person’s from the beginning, where more than the first is drawn.",
} as const;

export const mark = {
  pin: "Pin: {name}, {when}",
  start: "start",
  emergency: "EMERGENCY {name}",
  other_team: "{name} ({source})",
} as const;
