/** The list of people, its cards and the actions on a person. */
export const board = {
  title: "Board",
  print: "Print",
  no_incident: "No incident open",
  summary: "{incident}, {count, number} on scene, {time}",
  not_current: "Not current: the station is not connected.",
  crew: "Crew",
  unit: "Unit",
  state: "State",
  floor: "Floor",
  inside_for: "Inside for",
  floor_unknown: "not known",
} as const;

export const radio = {
  in_alarm: "In alarm: {members}. {question}",
  yes: "Yes, answered by radio",
} as const;

export const headcount = {
  title: "Headcount",
  on_scene: "On scene",
  inside: "Inside",
  outside: "Outside",
  rehab: "Rehab",
  not_located: "Not located",
  never_heard: "Never heard",
} as const;

export const card = {
  to_plan: "To this person on the plan",
  timeline: "Timeline",
  reasons: "{count, plural, one {Reason of the alarm} other {Reasons of the alarms}}",
  unassigned: "unassigned",
  unknown_unit: "unknown unit",
  unreliable: "Position unreliable",
  uncertain: "Position uncertain",
  reason: "{what}: {reason}",
  cannot_be_notified: "cannot be notified",
  cannot_be_notified_hint: "The unit has no output: use the voice radio",
  preflight: "Unit {state}",
  duplicate: "Duplicate unit ID: {reason}",
  unregistered: "Unregistered unit: logged, not used.",
  register: "Register",
  actions: "For {name}",
  par_by_radio: "PAR by radio",
  has_answered: "Has {name} answered by radio?",
  return_to_duty: "Return to duty",
  to_rehab: "To rehab",
  correct_position: "Correct position …",
  same_place: "Same place as …",
  locate: "Sound locator",
  locate_asks: "Sound locator …",
  message: "Message",
  members_down: "Members who are down",
  words: "{name}: {words}",
  not_located: "not located",
  no_position: "no position yet",
  old_place: "{place}, old",
  assign_incident: "Assign to this incident",
} as const;

export const fact = {
  position: "Position",
  not_updated: "Not updated",
  environment: "Environment",
  electronics: "Electronics",
  battery: "Battery",
  battery_low: "low",
  sensors: "Sensors",
  in_rehab: "In rehab",
} as const;

export const list = {
  by_need: "By need",
  by_crew: "By crew",
  by_name: "By name",
  title: "List of people",
  placeholder: "Name, unit or crew  ( / )",
  search: "Search by name, unit or crew",
  order: "Order of the list",
  lines: "One line each",
  board: "Board",
} as const;

export const confirmation = {
  not_yet_confirmed: "not yet confirmed",
  confirmed_by_unit: "confirmed {time} by own unit",
  confirmed_by_radio: "confirmed {time} by radio, entered by {who}",
  undo_par: "PAR of {whom}: confirmed by radio",
  undo_answer: "{whom}: answered by radio",
} as const;
