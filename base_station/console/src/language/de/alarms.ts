import type { Part } from "../catalogue";

export const alarm: Part<"alarm"> = {
  open: "Offene Alarme",
  none_open: "Keine offenen Alarme",
  count_open: "{count, number} offen",
  fewer: "Weniger",
  more: "+{count, number} weitere",
  one_by_one: "Einzeln",
  list: "Auflisten",
  row: "Der Alarm „{text}“",
  emergency: "Notfall",
  warning: "Warnung",
  advisory: "Hinweis",
  priority: "Priorität {number}",
  acknowledged_by: "quittiert von {who}",
  not_acknowledged: "nicht quittiert",
  acknowledge: "Quittieren",
  resolve: "Erledigt",
  of_member: "Alarme von {name}",
  none_open_of_member: "Keine offenen Alarme.",
  no_threshold:
    "Kein Messwert hat eine Schwelle überschritten: Eine Taste, ein Ereignis oder ausbleibende Meldungen haben ihn ausgelöst.",
  thresholds: "Schwellen zu dieser Zeit: {thresholds}.",
  unit_unassigned: "das Gerät trägt jetzt niemand",
  unit_of: "das Gerät trägt jetzt {name}",
  by_other: "(wer es vorher trug)",
  of_person: "Offene Alarme dieser Person",
  now: "jetzt {value}",
  last: "zuletzt {value}",
  has_moved: "hat sich seither bewegt",
  flood_at: "{what} um {time}",
  flood_from: "{what} von {from} bis {to}",
  flood_par: "{count, number} PAR überfällig",
  flood_off: "{count, number} Geräte wurden ausgeschaltet",
  flood_link: "{count, number} Geräte haben die Verbindung verloren",
  flood_other: "{count, number} Geräte: {alarm},",
  of_incident: "{incident}: {text}",
};

export const closing: Part<"closing"> = {
  open_alarms: "Offene Alarme: {names}.",
  inside: "Im Gebäude: {names}.",
};
