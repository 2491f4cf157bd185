import type { Part } from "../catalogue";

export const board: Part<"board"> = {
  title: "Übersichtstafel",
  print: "Drucken",
  no_incident: "Kein Einsatz offen",
  summary: "{incident}, {count, number} vor Ort, {time}",
  not_current: "Nicht aktuell: Die Station ist nicht verbunden.",
  crew: "Trupp",
  unit: "Gerät",
  state: "Zustand",
  floor: "Geschoss",
  inside_for: "Im Gebäude seit",
  floor_unknown: "unbekannt",
};

export const radio: Part<"radio"> = {
  in_alarm: "Im Alarm: {members}. {question}",
  yes: "Ja, über Funk gemeldet",
};

export const headcount: Part<"headcount"> = {
  title: "Stärke",
  on_scene: "Vor Ort",
  inside: "Im Gebäude",
  outside: "Außerhalb",
  rehab: "Erholung",
  not_located: "Nicht geortet",
  never_heard: "Nie empfangen",
};

export const card: Part<"card"> = {
  to_plan: "Zu dieser Person auf dem Plan",
  timeline: "Zeitverlauf",
  reasons: "{count, plural, one {Grund des Alarms} other {Gründe der Alarme}}",
  unassigned: "nicht zugeordnet",
  unknown_unit: "unbekanntes Gerät",
  unreliable: "Position unzuverlässig",
  uncertain: "Position unsicher",
  reason: "{what}: {reason}",
  cannot_be_notified: "nicht benachrichtigbar",
  cannot_be_notified_hint: "Das Gerät hat keinen Signalgeber: Sprechfunk verwenden",
  preflight: "Gerät {state}",
  duplicate: "Doppelte Gerätekennung: {reason}",
  unregistered: "Nicht registriertes Gerät: aufgezeichnet, nicht verwendet.",
  register: "Registrieren",
  actions: "Für {name}",
  par_by_radio: "PAR über Funk",
  has_answered: "Hat sich {name} über Funk gemeldet?",
  return_to_duty: "Wieder einsatzbereit",
  to_rehab: "In Erholung",
  correct_position: "Position korrigieren …",
  same_place: "Am selben Ort wie …",
  locate: "Ortungssignal",
  locate_asks: "Ortungssignal …",
  message: "Nachricht",
  members_down: "Personen in Not",
  words: "{name}: {words}",
  not_located: "nicht geortet",
  no_position: "noch keine Position",
  old_place: "{place}, alt",
  assign_incident: "Diesem Einsatz zuordnen",
};

export const fact: Part<"fact"> = {
  position: "Position",
  not_updated: "Nicht aktuell",
  environment: "Umgebung",
  electronics: "Elektronik",
  battery: "Akku",
  battery_low: "schwach",
  sensors: "Sensoren",
  in_rehab: "In Erholung seit",
};

export const list: Part<"list"> = {
  by_need: "Nach Dringlichkeit",
  by_crew: "Nach Trupp",
  by_name: "Nach Name",
  title: "Liste der Personen",
  placeholder: "Name, Gerät oder Trupp  ( / )",
  search: "Nach Name, Gerät oder Trupp suchen",
  order: "Reihenfolge der Liste",
  lines: "Einzeilig",
  board: "Übersichtstafel",
};

export const confirmation: Part<"confirmation"> = {
  not_yet_confirmed: "noch nicht bestätigt",
  confirmed_by_unit: "um {time} mit eigenem Gerät bestätigt",
  confirmed_by_radio: "um {time} über Funk bestätigt, eingetragen von {who}",
  undo_par: "PAR von {whom}: über Funk bestätigt",
  undo_answer: "{whom}: über Funk geantwortet",
};
