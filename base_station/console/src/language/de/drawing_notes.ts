/** Notes on a drawing that was read, by the codes of their sentences, in German. */
import type { Part } from "../catalogue";

export const drawing_note: Part<"drawing_note"> = {
  "note-columns": "Stützen",
  "note-doors": "Türen",
  "note-dxf-no-walls": "Keine Ebene heißt nach Wänden: Jede Linie gilt als eine.",
  "note-dxf-unit": "Seine Längeneinheit ist {unit}; es liegt mit der linken unteren Ecke im Ursprung.",
  "note-features-left-out":
    "{count, plural, one {# Objekt ist ein Punkt oder für einen Plan ohne Nutzen und wurde weggelassen.} other {# Objekte sind Punkte oder für einen Plan ohne Nutzen und wurden weggelassen.}}",
  "note-floors": "Seine Stockwerke: {floors}.",
  "note-left-out": "Weggelassen: {elements}: {count, number}.",
  "note-lifts": "Aufzüge",
  "note-no-class": "Elemente ohne Klasse",
  "note-no-passage": "{elements} ohne Tür, die zu klein sind oder über dem Boden beginnen",
  "note-no-place": "Ohne Ort auf der Erde: an zwei Punkten ausrichten.",
  "note-no-walls": "Ohne Wände: Räume werden gezeichnet, und Wege können durch sie hindurch führen.",
  "note-not-cut": "{elements} nicht {cut_m} über einem Boden",
  "note-openings": "Öffnungen",
  "note-other-grid": "Sein Ort ist im Gitter {grid} angegeben, nicht in UTM.",
  "note-outside-zone": "Sein Ort in {grid} liegt außerhalb dieser Zone.",
  "note-rooms": "Räume",
  "note-stairs": "Treppen",
  "note-storeys-left-out": "Geschosse ohne Türen, Räume und Treppen sind weggelassen: {names}.",
  "note-suggested":
    "Sein Ort auf der Erde ist der seines Grundstücks, den viele Zeichenprogramme von selbst setzen: vor dem Gebrauch ansehen.",
  "note-too-low": "{elements} niedriger als {steps_m}",
  "note-walls": "Wände",
  "note-without-shape": "{elements} ohne Form",
};
