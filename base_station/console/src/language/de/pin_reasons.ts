/** Why a pin is not used yet, or what it contradicts, by the codes of the sentences, in German. */
import type { Part } from "../catalogue";

export const pin_reason: Part<"pin_reason"> = {
  "pin-after": "{pin} von {apart_s} danach",
  "pin-against-fixes": "{path} und die Satellitenpositionen",
  "pin-against-pin": "{pin} und {path}",
  "pin-path-behind": "der Weg des Geräts reicht noch nicht bis zu dieser Zeit",
  "pin-beacon-unplaced": "der Ort der Bake {beacon} ist nicht gesetzt",
  "pin-before": "{pin} von {apart_s} davor",
  "pin-path-later":
    "der bekannte Weg beginnt {early_s} später: Das Journal des Geräts kann noch bringen, was davor war; sonst geben Sie dem Pin eine spätere Zeit",
  "pin-conflict":
    "{away_m} entfernt von der Stelle, zu der {against} führen: das {times, number}-Fache des Erwarteten; aufbewahrt und nicht verwendet",
  "pin-conflict-above":
    "{away_m} über der Stelle, zu der {against} führen: das {times, number}-Fache des Erwarteten; aufbewahrt und für {unit} nicht verwendet, außer ein anderer Pin bestätigt es",
  "pin-conflict-below":
    "{away_m} unter der Stelle, zu der {against} führen: das {times, number}-Fache des Erwarteten; aufbewahrt und für {unit} nicht verwendet, außer ein anderer Pin bestätigt es",
  "pin-conflict-meeting":
    "{away_m} entfernt von der Stelle, zu der {against} führen: das {times, number}-Fache des Erwarteten; aufbewahrt und für {unit} nicht verwendet",
  "pin-named": "der Pin",
  "pin-named-beacon": "die Bake {beacon}",
  "pin-named-meeting": "das Treffen mit {unit}",
  "pin-named-note": "der Pin „{note}“",
  "pin-named-start": "der Pin am Start",
  "pin-named-tag": "der Anhänger {tag}",
  "pin-no-position": "von diesem Gerät ist noch keine Position gekommen",
  "pin-no-position-of": "von {unit} ist noch keine Position gekommen",
  "pin-not-solved": "noch nicht berechnet",
  "pin-path-of": "der Weg von {unit}",
  "pin-path-walked": "der gegangene Weg",
  "pin-position-poor": "die Position von {unit} war nicht genau genug bekannt",
  "pin-reason-of-unit": "{unit}: {reason}",
  "pin-reasons": "{before}. {last}",
  "pin-same-time": "{pin} zur selben Zeit",
  "pin-tag-unplaced": "der Ort des Anhängers {tag} ist nicht gesetzt",
};
