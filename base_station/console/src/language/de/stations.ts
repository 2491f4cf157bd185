import type { Part } from "../catalogue";

export const sound: Part<"sound"> = {
  off: "Ton aus",
  on: "Ton an",
  blocked: "Noch kein Ton",
  heard: "Alarme sind zu hören",
  press: "Drücken, um Alarme zu hören",
};

export const standby: Part<"standby"> = {
  title: "Reservestation",
  is_standby: "{station} ist die Reservestation.",
  waits: "Sie wartet auf die andere Station und führt nicht.",
  other_leads: "{other} führt. Hier kann man zusehen; geändert wird dort.",
  behind: "Sie ist noch nicht auf dem Stand: das Gezeigte kann alt sein.",
  reading: "Protokoll wird gelesen",
  reading_share: "Die Basisstation liest ihr Protokoll: {share}.",
  reading_hint:
    "Gezeigt ist das zuletzt Gespeicherte: nichts ist live, und noch nichts kann geändert werden. Die Geräte arbeiten weiter; was sie inzwischen melden, wird nachgeholt.",
  open_other: "Konsole von {other} öffnen",
  take_over: "Übernehmen",
  take_over_question: "{station} führt von jetzt an.",
};

export const away: Part<"away"> = {
  title: "Basisstation nicht erreichbar",
  hint:
    "Die Basisstation antwortet unter {host} nicht. Nichts wird gezeigt, da nichts auf dieser Seite aktuell ist. Sprechfunk benutzen.",
  tried:
    "Versuche seit {time}, {duration} lang. Die Konsole erscheint von selbst, sobald die Basisstation antwortet.",
  again: "Jetzt erneut versuchen",
};

export const waiting: Part<"waiting"> = {
  asking: "Basisstation wird gefragt …",
  sending: "Wird gesendet …",
};

export const wall: Part<"wall"> = {
  no_incident: "Kein Einsatz offen",
  inside: "{count, number} innen",
  leave: "Wandanzeige verlassen",
  people: "Personen",
  more_well: "+{count, number} weitere, niemand in Not",
  more: "+{count, number} weitere, davon {needing, number} in Not",
  unassigned: "Nicht zugewiesen",
  elsewhere: "{incident}: {words}",
};
