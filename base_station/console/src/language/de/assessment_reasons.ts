/** Why a place was in doubt, or a position not used, by the words of the station, in German. */
import type { Part } from "../catalogue";

export const assessment_reason: Part<"assessment_reason"> = {
  "not a registered unit":
    "kein registriertes Gerät",
  "no position yet":
    "noch keine Position",
  "no message":
    "keine Nachricht",
  "place only roughly known":
    "Ort nur ungefähr bekannt",
  "a pin contradicts the trail":
    "ein Pin widerspricht der Spur",
  "floor not sure":
    "Geschoss nicht sicher",
  "height only roughly known":
    "Höhe nur ungefähr bekannt",
  "start not known":
    "Anfang nicht bekannt",
  "heading not known yet":
    "Richtung noch nicht bekannt",
  "walls leave more than one place open":
    "die Wände lassen mehr als einen Ort zu",
  "the unit's tracker is lost":
    "die Ortung des Geräts ist verloren",
  "the unit's tracker is unsure":
    "die Ortung des Geräts ist unsicher",
  "heading not settled":
    "Richtung nicht eingeschwungen",
  "the receiver has no fix":
    "der Empfänger hat keine Position",
  "from an earlier run of the unit":
    "aus einem früheren Lauf des Geräts",
  "of a time that no other message has placed yet":
    "aus einer Zeit, die noch keine andere Nachricht einordnet",
  "of before it came to this incident":
    "aus der Zeit vor diesem Einsatz",
  "from the future":
    "aus der Zukunft",
  "the site has no anchor":
    "die Einsatzstelle hat keinen Anker",
  "fits, but the receiver was wrong just before":
    "passt, aber der Empfänger lag eben noch falsch",
  "does not fit the path walked":
    "passt nicht zum gegangenen Weg",
  "contradicts the path, and agrees with others: going there":
    "widerspricht dem Weg und stimmt mit anderen überein: übernommen",
  "older than the last position":
    "älter als die letzte Position",
  "the unit's own path jumped":
    "der eigene Weg des Geräts ist gesprungen",
  "coordinates that are no numbers":
    "Koordinaten, die keine Zahlen sind",
  "coordinates that are not on the Earth":
    "Koordinaten, die nicht auf der Erde liegen",
  "latitude and longitude 0":
    "Breite und Länge 0",
  "a height at which nobody stands":
    "eine Höhe, in der niemand steht",
  "an accuracy that cannot be used":
    "eine Genauigkeit, die nicht zu brauchen ist",
  "too far from the site":
    "zu weit von der Einsatzstelle",
  "the receiver is stuck":
    "der Empfänger hängt",
  "a sighting of a unit that is not registered":
    "Sichtung durch ein nicht registriertes Gerät",
  "a sighting of nothing":
    "Sichtung ohne Gegenstand",
  "a sighting of an unknown time":
    "Sichtung unbekannter Zeit",
  "a sighting of before this incident":
    "Sichtung aus der Zeit vor diesem Einsatz",
  "a sighting from too far away":
    "Sichtung aus zu großer Entfernung",
  "a meeting with an unknown unit":
    "Begegnung mit einem unbekannten Gerät",
  "a meeting with itself":
    "Begegnung mit sich selbst",
  "a meeting with a unit of another incident":
    "Begegnung mit einem Gerät eines anderen Einsatzes",
  "no room for sightings beside what people pinned":
    "neben den gesetzten Pins kein Platz für Sichtungen",
};
