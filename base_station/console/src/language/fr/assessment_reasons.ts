/** Why a place was in doubt, or a position not used, by the words of the station, in French. */
import type { Part } from "../catalogue";

export const assessment_reason: Part<"assessment_reason"> = {
  "not a registered unit":
    "boîtier non enregistré",
  "no position yet":
    "pas encore de position",
  "no message":
    "aucun message",
  "place only roughly known":
    "lieu connu seulement à peu près",
  "a pin contradicts the trail":
    "un repère contredit la trace",
  "floor not sure":
    "étage incertain",
  "height only roughly known":
    "hauteur connue seulement à peu près",
  "start not known":
    "départ inconnu",
  "heading not known yet":
    "cap pas encore connu",
  "walls leave more than one place open":
    "les murs laissent plus d’un lieu possible",
  "the unit's tracker is lost":
    "le suivi du boîtier est perdu",
  "the unit's tracker is unsure":
    "le suivi du boîtier est incertain",
  "heading not settled":
    "cap pas stabilisé",
  "the receiver has no fix":
    "le récepteur n’a pas de position",
  "from an earlier run of the unit":
    "d’une marche antérieure du boîtier",
  "of a time that no other message has placed yet":
    "d’un moment qu’aucun autre message n’a encore situé",
  "of before it came to this incident":
    "d’avant son arrivée dans cette intervention",
  "from the future":
    "du futur",
  "the site has no anchor":
    "le site n’a pas d’ancre",
  "fits, but the receiver was wrong just before":
    "concorde, mais le récepteur était faux juste avant",
  "does not fit the path walked":
    "ne concorde pas avec le parcours",
  "contradicts the path, and agrees with others: going there":
    "contredit le parcours et concorde avec d’autres\u00a0: adopté",
  "older than the last position":
    "plus ancien que la dernière position",
  "the unit's own path jumped":
    "le parcours propre du boîtier a sauté",
  "coordinates that are no numbers":
    "coordonnées qui ne sont pas des nombres",
  "coordinates that are not on the Earth":
    "coordonnées qui ne sont pas sur la Terre",
  "latitude and longitude 0":
    "latitude et longitude 0",
  "a height at which nobody stands":
    "une hauteur où personne ne se tient",
  "an accuracy that cannot be used":
    "une précision inutilisable",
  "too far from the site":
    "trop loin du site",
  "the receiver is stuck":
    "le récepteur est bloqué",
  "a sighting of a unit that is not registered":
    "détection par un boîtier non enregistré",
  "a sighting of nothing":
    "détection sans objet",
  "a sighting of an unknown time":
    "détection d’heure inconnue",
  "a sighting of before this incident":
    "détection d’avant cette intervention",
  "a sighting from too far away":
    "détection de trop loin",
  "a meeting with an unknown unit":
    "rencontre avec un boîtier inconnu",
  "a meeting with itself":
    "rencontre avec soi-même",
  "a meeting with a unit of another incident":
    "rencontre avec un boîtier d’une autre intervention",
  "no room for sightings beside what people pinned":
    "pas de place pour les détections à côté des repères posés",
};
