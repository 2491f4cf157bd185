/** Why a pin is not used yet, or what it contradicts, by the codes of the sentences, in French. */
import type { Part } from "../catalogue";

export const pin_reason: Part<"pin_reason"> = {
  "pin-after": "{pin} de {apart_s} après",
  "pin-against-fixes": "{path} et les positions satellite",
  "pin-against-pin": "{pin} et {path}",
  "pin-path-behind": "le trajet du boîtier n’est pas encore arrivé à cette heure",
  "pin-beacon-unplaced": "l’emplacement de la balise {beacon} n’est pas défini",
  "pin-before": "{pin} de {apart_s} avant",
  "pin-path-later":
    "le trajet connu commence {early_s} plus tard\u00a0: le journal du boîtier peut encore apporter ce qui précède, sinon donnez au repère une heure plus tardive",
  "pin-conflict":
    "à {away_m} de l’endroit où mènent {against}\u00a0: {times, number} fois l’écart attendu\u00a0; conservé, mais pas utilisé",
  "pin-conflict-above":
    "{away_m} au-dessus de l’endroit où mènent {against}\u00a0: {times, number} fois l’écart attendu\u00a0; conservé, mais pas utilisé pour {unit} tant qu’un autre repère ne le confirme pas",
  "pin-conflict-below":
    "{away_m} au-dessous de l’endroit où mènent {against}\u00a0: {times, number} fois l’écart attendu\u00a0; conservé, mais pas utilisé pour {unit} tant qu’un autre repère ne le confirme pas",
  "pin-conflict-meeting":
    "à {away_m} de l’endroit où mènent {against}\u00a0: {times, number} fois l’écart attendu\u00a0; conservé, mais pas utilisé pour {unit}",
  "pin-named": "le repère",
  "pin-named-beacon": "la balise {beacon}",
  "pin-named-meeting": "la rencontre avec {unit}",
  "pin-named-note": "le repère «\u00a0{note}\u00a0»",
  "pin-named-start": "le repère de départ",
  "pin-named-tag": "l’étiquette {tag}",
  "pin-no-position": "aucune position de ce boîtier n’est encore arrivée",
  "pin-no-position-of": "aucune position de {unit} n’est encore arrivée",
  "pin-not-solved": "pas encore calculé",
  "pin-path-of": "le trajet de {unit}",
  "pin-path-walked": "le trajet parcouru",
  "pin-position-poor": "la position de {unit} n’était pas assez bien connue",
  "pin-reason-of-unit": "{unit}\u00a0: {reason}",
  "pin-reasons": "{before}. {last}",
  "pin-same-time": "{pin} à la même heure",
  "pin-tag-unplaced": "l’emplacement de l’étiquette {tag} n’est pas défini",
};
