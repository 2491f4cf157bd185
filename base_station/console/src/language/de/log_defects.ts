/** Defects of a log, by the codes of their sentences, in German. */
import type { Part } from "../catalogue";

export const log_defect: Part<"log_defect"> = {
  "bytes-behind-end": "die Datei endet vorher",
  "bytes-cut": "die Datei wurde inzwischen gekürzt",
  "bytes-unreadable": "der Datenträger gibt es nicht her: {error}",
  "chunk-checksum": "die Prüfsumme ist falsch",
  "chunk-head": "der Kopf ergibt keinen Sinn",
  "chunk-packed": "er lässt sich nicht entpacken",
  "flaws-more": "und {count, number} weitere, die im Terminal stehen",
  "foreign-empty": "nichts darin ist lesbar",
  "foreign-log": "sie gehört zu einem anderen Log",
  "foreign-name": "der Name ist nicht der eines Segments",
  "foreign-order": "der Name passt nicht zu den anderen",
  "foreign-program": "ein anderes Programm hat sie geschrieben ({program})",
  "foreign-time": "die Einträge beginnen am {began_utc_s}, nicht zur Zeit im Namen",
  "foreign-unnamed-program": "ein anderes Programm hat sie geschrieben, das sich nicht nennt",
  "foreign-version":
    "eine frühere Version von Muster hat sie geschrieben; sie kann nicht hinter diesem Log kommen",
  "gap-file-empty": "{file} ist leer: {what}, ist nicht oder nicht ganz bekannt",
  "gap-file-missing": "{file} fehlt: {what}, ist nicht oder nicht ganz bekannt",
  "gap-messages-missing":
    "{file} hat {kept, number} seiner {of, number} Meldungen: {what}, ist nicht oder nicht ganz bekannt",
  "gap-number-missing": "Segment {number} fehlt: {what}, ist nicht oder nicht ganz bekannt",
  "gaps-joined": "{first}; {others}",
  "gaps-more": "und {count, number} weitere",
  "log-part-unreadable": "ein Teil des Logs ist nicht lesbar: {part}",
  "log-segment-missing": "Segment {number} des Logs fehlt: {what}, ist nicht bekannt",
  "log-segments-missing": "die Segmente {first} bis {last} des Logs fehlen: {what}, ist nicht bekannt",
  "replay-from-archive":
    "aus dem Archiv gezeigt: Wege, Berichte und Genauigkeitsberichte brauchen das Ganze; „muster base archive fetch“ holt es",
  "replay-version":
    "diese Version von Muster entscheidet anders als die Basisstation damals: Orte und Alarme der Wiedergabe können von dem abweichen, was gezeigt wurde und im Log steht",
  "segment-bytes": "{file}: die Bytes {offset, number} bis {until, number} ergeben keinen Sinn",
  "segment-chunk-lost": "{file}: der Block bei Byte {offset, number} ist verloren ({reason})",
  "segment-contents": "{file}: das Inhaltsverzeichnis ist beschädigt und wurde neu gemacht",
  "segment-foreign": "{file} ist kein Segment dieses Logs und bleibt weg: {reason}",
  "segment-gone": "{path} ist nicht lesbar: {error}",
  "segment-index": "{file}: der Index des Blocks bei Byte {offset, number} ist beschädigt; ohne ihn gelesen",
  "segment-keys-lost":
    "{file}: {count, plural, one {# Eintrag ist verloren, dessen Schlüssel} other {# Einträge sind verloren, deren Schlüssel}} in einem beschädigten Teil stand",
  "segment-torn":
    "{file} wurde nicht ordnungsgemäß beendet: {count, plural, one {Das letzte Byte ist} other {Die letzten # Bytes sind}} nicht lesbar",
  "segment-unreadable": "{file}: der Datenträger gibt die Datei nicht her ({error})",
  "segment-unreadable-part": "{file}: der Datenträger gibt nicht die ganze Datei her",
  "time-between": "was vom {from_utc_s} bis zum {until_utc_s} geschah",
  "time-since": "was ab dem {from_utc_s} geschah",
  "time-unknown": "was geschah",
  "time-until": "was bis zum {until_utc_s} geschah",
};
