/** Warnings about imported files, by their codes, in German. */
import type { Part } from "../catalogue";

export const import_warning: Part<"import_warning"> = {
  "import-breaks-off": "sie lässt sich nicht bis zum Ende lesen ({error}): Was danach kommt, fehlt",
  "import-far": "sie beginnt {away_km} vom Ort des Einsatzes entfernt",
  "import-incomplete": "die Datei ist unvollständig: Die Namen der Personen und das Letzte fehlen",
  "import-other-version":
    "{count, plural, one {ein Eintrag ließ} other {# Einträge ließen}} sich nicht lesen: von einer anderen Version von Muster geschrieben",
  "import-part-damaged": "ein Teil davon lässt sich nicht lesen: {damage}",
  "import-places-left-out":
    "{count, plural, one {ein Ort ohne Zeit wird} other {# Orte ohne Zeit werden}} weggelassen",
  "import-points-left-out":
    "{count, plural, one {ein Punkt ohne Ort oder Zeit wird} other {# Punkte ohne Ort oder Zeit werden}} weggelassen",
  "import-time-of-fix": "die Zeit ist die der Satellitenortung der Kamera; das Bild kann später aufgenommen sein",
  "import-unplaced":
    "{count, plural, one {eine Position} other {# Positionen}} aus der Zeit vor der Lage des Orts: weggelassen",
};
