import type { Part } from "../catalogue";

export const role: Part<"role"> = {
  viewer: "Beobachter",
  commander: "Einsatzleiter",
  administrator: "Administrator",
};

export const account: Part<"account"> = {
  title: "Angemeldet als {name} ({role})",
  users: "Benutzer",
  log_out: "Abmelden",
  password: "Passwort",
  password_changed: "Das Passwort ist geändert. Melden Sie sich mit dem neuen an.",
  old_password: "Altes Passwort",
  new_password: "Neues Passwort, mindestens 10 Zeichen",
  change_password: "Passwort ändern",
};

export const token: Part<"token"> = {
  title: "API-Token",
  name: "Wofür er ist",
  role: "Rolle",
  days: "Gültig für Tage (leer: immer)",
  scopes: "Teile der Station (keiner gewählt: alle)",
  make: "Token erzeugen",
  made: "Kopieren Sie ihn jetzt, er wird nicht noch einmal gezeigt: {token}",
  token: "Token",
  may: "Darf",
  valid_until: "Gültig bis",
  always: "immer",
  all_parts: "alle Teile",
  remove_question: "Programme, die ihn verwenden, werden ausgesperrt.",
};

export const audit: Part<"audit"> = {
  title: "Protokoll",
  when: "Wann",
  who: "Wer",
  action: "Tat",
  what: "Was",
  older: "Ältere Einträge",
};

export const scope: Part<"scope"> = {
  accountability: "Vollzähligkeit",
  alarms: "Alarme",
  assignments: "Zuordnungen",
  audit: "Protokoll",
  commands: "Befehle",
  dispatch: "Leitstelle",
  enrolments: "Anmeldungen von Geräten",
  exports: "Exporte",
  forgetting: "Löschung",
  health: "Zustand",
  incidents: "Einsätze",
  live: "Live",
  people: "Personen",
  pins: "Pins",
  radio: "Funk",
  recordings: "Aufzeichnungen",
  replays: "Wiedergaben",
  samples: "Messwerte",
  site: "Ort",
  standby: "Reservestation",
  tokens: "Token",
  tracks: "Spuren",
  units: "Geräte",
  users: "Benutzer",
};

export const login: Part<"login"> = {
  not_the_same: "Die beiden sind nicht gleich; geben Sie das neue Passwort noch einmal ein.",
  log_in: "Anmelden",
  user: "Benutzer",
  generated:
    "Dieses Passwort hat die Station erzeugt; es steht in einer Datei. Wählen Sie ein eigenes, bevor Sie weitermachen.",
  again: "Neues Passwort noch einmal",
  ended: "Diese Anmeldung ist beendet. Melden Sie sich wieder an: Ihre Arbeit ist noch da.",
  came_from: "Sie kommen von der Konsole der Station „{station}“.",
  same_here: "{origin} Derselbe Benutzer und dasselbe Passwort gelten hier.",
  press_ok: "{origin} Drücken Sie OK: Vorher ist hier kein Alarm zu hören.",
};
