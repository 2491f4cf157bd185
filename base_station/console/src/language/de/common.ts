import type { Part } from "../catalogue";

export const common: Part<"common"> = {
  close: "Schließen",
  save: "Speichern",
  remove: "Entfernen",
  no: "Nein",
  ok: "OK",
  undo: "Rückgängig",
  yes: "Ja: {action}",
  about: "{action}: {what}",
  show_on_plan: "Auf dem Plan zeigen",
  hint: "{what}. {action}",
  name: "Name",
  cannot_show: "{what} kann nicht angezeigt werden: {problem}",
  press_ignored: "Die Liste hat sich gerade geändert, das Drücken blieb ohne Wirkung. Bitte noch einmal drücken.",
  not_loaded: "Dieser Teil der Seite wurde nicht geladen. Laden Sie die Seite neu.",
};
