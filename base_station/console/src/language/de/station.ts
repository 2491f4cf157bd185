import type { Part } from "../catalogue";

export const station: Part<"station"> = {
  not_encrypted: "Nicht verschlüsselt: andere im Netz können mithören und senden",
};

export const forwarder: Part<"forwarder"> = {
  connected: "verbunden",
  connecting: "nicht verbunden",
  standby: "die andere Station leitet weiter",
  line: "{kind} {name} ({address}): {state}",
  sent: "{count, number} Ereignisse gesendet",
  received: "{count, number} empfangen",
  refused: "{count, number} ausgelassen",
};

export const health: Part<"health"> = {
  title: "Zustand der Basisstation",
  ok: "Basisstation in Ordnung",
  unknown: "Zustand der Basisstation unbekannt",
  light: "Basisstation: {sentence} {others}",
  messages: "Empfangene Meldungen",
  messages_per_s: "Meldungen pro Sekunde",
  undecodable: "Nicht lesbare Meldungen",
  duplicates: "Doppelte Meldungen",
  unknown_units: "Unbekannte Geräte",
  recorded: "Aufgezeichnet",
  disk_free: "Freier Speicherplatz",
};

export const connection: Part<"connection"> = {
  connected: "Verbunden",
  connected_to: "Verbunden mit {station}",
  lost: "Verbindung verloren",
  connecting: "Verbindet",
  picture_from: "Dieses Bild ist von {time} und wird nicht aktualisiert.",
  trying: "Neuer Verbindungsversuch läuft.",
  nothing_updated: "Hier wird nichts aktualisiert.",
  lost_since: "Verbindung zur Station verloren, {age}.",
  unreachable: "Die Basisstation ist nicht erreichbar.",
  outcome_unknown:
    "Keine Antwort von der Basisstation. Prüfen Sie, ob der Befehl hinausging, bevor Sie ihn wiederholen.",
  answered: "Die Station hat mit {status, number} geantwortet.",
  carried_out: "Was ohne Antwort blieb, wurde um {time} ausgeführt.",
  not_carried_out:
    "Was ohne Antwort blieb, wurde nicht ausgeführt. Geben Sie den Befehl noch einmal, wenn er noch gewünscht ist.",
  title_lost: "KEINE VERBINDUNG – Muster",
  title_replay: "Wiedergabe – Muster",
  title_alarms: "({count, number}!) Muster",
};

export const systems: Part<"systems"> = {
  title: "Andere Systeme",
  label: "Weiterleitungen",
};

export const archive: Part<"archive"> = {
  line: "Archiv {location}: {state}",
  waiting: "nimmt beendete Einsätze",
  copying: "ein Einsatz wird kopiert",
  away: "nicht erreichbar",
  incidents: "{count, plural, one {# Einsatz wartet} other {# Einsätze warten}}",
  last: "zuletzt {time}",
};
