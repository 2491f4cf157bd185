import type { Part } from "../catalogue";

export const display: Part<"display"> = {
  title: "Anzeige",
  theme: "Farben",
  theme_system: "Wie dieses Gerät",
  theme_light: "Hell",
  theme_dark: "Dunkel",
  theme_red: "Rotlicht",
  language: "Sprache",
  language_browser: "Wie dieser Browser",
  language_missing:
    "Die Texte dieser Sprache sind noch nicht von der Station gekommen; sie wird wieder gefragt.",
  units: "Einheiten",
  units_metric: "Metrisch: m, °C",
  units_imperial: "Angloamerikanisch: ft, °F",
  floors: "Geschosse",
  floors_european: "Europäisch: Erdgeschoss, 1. Obergeschoss",
  floors_american: "Amerikanisch: 1. Etage, 2. Etage",
  wall: "Wandanzeige",
  wall_use: "Namen, Zustand und Geschoss, aus 2 m zu lesen",
  gloves: "Handschuhe",
  gloves_use: "Große Schaltflächen (15 mm)",
  plan_marks: "Zeichen auf dem Plan",
  shortcuts: "Tastenkürzel",
  shortcuts_use: "Verwenden",
  speech: "Gesprochene Alarme",
  speech_use: "Jeden Notfall und jede Warnung nach dem Ton ansagen",
  speech_impossible: "Dieser Browser kann nicht sprechen.",
};

export const language_name: Part<"language_name"> = {
  en: "English",
  de: "Deutsch",
  fr: "Français",
};

export const shortcut: Part<"shortcut"> = {
  evacuate: "Räumung: öffnet den Befehl, sendet noch nichts",
  par: "PAR: öffnet die Abfrage, sendet noch nichts",
  next_alarm: "Nächster Alarm: zeigt die Person auf dem Plan",
  all_alarms: "Alle Alarme, und was aus jedem wurde",
  section: "Gebäudeschnitt statt des Plans, und zurück",
  search: "Personenliste durchsuchen",
  help: "Diese Liste",
};
