/** Display settings of this browser. */
export const display = {
  title: "Display",
  theme: "Theme",
  theme_system: "As this device",
  theme_light: "Light",
  theme_dark: "Dark",
  theme_red: "Red light",
  language: "Language",
  language_browser: "As this browser",
  language_missing:
    "The texts of this language have not come from the station yet; it is asked again.",
  units: "Units",
  units_metric: "Metric: m, °C",
  units_imperial: "Imperial: ft, °F",
  floors: "Floors",
  floors_european: "European: ground floor, floor 1",
  floors_american: "American: 1st floor, 2nd floor",
  wall: "Wall",
  wall_use: "Names, state and floor, to be read from 2 m",
  gloves: "Gloves",
  gloves_use: "Large targets (15 mm)",
  plan_marks: "Marks on the plan",
  shortcuts: "Keyboard shortcuts",
  shortcuts_use: "Use them",
  speech: "Spoken alarms",
  speech_use: "Say each emergency and warning after its tone",
  speech_impossible: "This browser cannot speak.",
} as const;

export const language_name = {
  en: "English",
  de: "Deutsch",
  fr: "Français",
} as const;

export const shortcut = {
  evacuate: "Evacuate: opens the order, sends nothing yet",
  par: "PAR: opens the request, sends nothing yet",
  next_alarm: "Next alarm: shows its member on the plan",
  all_alarms: "All alarms, with what became of each",
  section: "Side section of the building instead of the plan, and back",
  search: "Search the list of people",
  help: "This list",
} as const;
