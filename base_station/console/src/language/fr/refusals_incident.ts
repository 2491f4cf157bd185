/** Refusals about incidents, orders, alarms and pins, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_incident: Part<"refusal_incident"> = {
  "alarm-acknowledged":
    "{by} l’a déjà acquittée",
  "alarm-not-open":
    "Il n’y a pas d’alarme en cours {alarm}",
  "alarm-of-station":
    "Cette alarme concerne la station elle-même\u00a0; elle n’a pas de valeurs d’un boîtier.",
  "alarm-raised-anew":
    "L’alarme a été déclenchée de nouveau depuis que vous l’avez vue\u00a0; regardez encore\u00a0: {alarm}",
  "alarm-unknown":
    "Cette alarme n’existe pas.",
  "all-clear-names-none":
    "Une fin d’évacuation en termine une\u00a0: nommez-la",
  "anchor-no-place":
    "{lat_deg}, {lon_deg} n’est pas une latitude et une longitude",
  "beacon-gone":
    "Il n’y a pas de balise {beacon}\u00a0; elle a peut-être déjà été supprimée",
  "beacon-reach":
    "La portée d’une balise est un nombre de mètres, 0 ou plus",
  "beacon-unknown":
    "Cette balise n’existe pas.",
  "check-in-addressee":
    "Indiquez l’un d’eux\u00a0: un boîtier, un binôme ou un étage qui a des membres, tous",
  "check-in-id-taken":
    "Une confirmation a besoin de son propre identifiant, et non {check_in}",
  "check-in-nobody":
    "Personne parmi {recipients, select, everyone {tous} other {{recipients}}} n’est en service dans une intervention en cours",
  "command-acknowledged":
    "{by} l’a déjà confirmé",
  "command-addressee":
    "Indiquez l’un d’eux\u00a0: un boîtier, un binôme ou un étage qui a des membres, tous",
  "command-id-taken":
    "Un ordre a besoin de son propre identifiant, et non {command}",
  "command-incident-closed":
    "Son intervention est clôturée\u00a0: ce qui y a été noté reste tel quel",
  "command-kind-unknown":
    "La station ne connaît pas ce genre d’ordre",
  "command-lasts":
    "Un ordre dure au plus un jour, et non {lasts_s}",
  "command-not-by-radio":
    "Un tel ordre ne concerne que le boîtier\u00a0: on n’y répond pas par radio",
  "command-not-to-unit":
    "Il n’y a pas d’ordre {command} à {unit}",
  "command-of-station":
    "La station l’envoie d’elle-même\u00a0; cela ne peut pas être ordonné",
  "command-over":
    "L’ordre est terminé\u00a0: ce qui y a été noté reste tel quel",
  "command-recipients-none":
    "Aucun boîtier enregistré ne peut le recevoir\u00a0: {recipients, select, everyone {tous} other {{recipients}}}",
  "command-unknown":
    "Cet ordre n’existe pas.",
  "commands-too-many":
    "{most} ordres sont ouverts\u00a0; attendez que certains aient une réponse",
  "dispatch-not-listed":
    "Il n’y a pas de départ {number}.",
  "dispatch-opened":
    "Le départ {number} a déjà ouvert l’intervention «\u00a0{incident}\u00a0»",
  "dispatch-unknown":
    "Il n’y a pas de départ {number} dont aucune intervention n’a été ouverte",
  "evacuation-ordered-anew":
    "Tous ont reçu depuis un nouvel ordre de sortir\u00a0: terminez cette évacuation-là",
  "evacuation-over":
    "Cette évacuation est déjà terminée",
  "evacuation-unknown":
    "Il n’y a pas d’évacuation {command} à terminer",
  "floor-not-on-plan":
    "Le plan n’a pas d’étage {floor}\u00a0; il a\u00a0: {known}",
  "floor-out-of-range":
    "Aucun bâtiment n’a d’étage {floor}\u00a0; de {lowest} à {highest} cela a un sens",
  "guides-too-many":
    "{most} sauveteurs sont guidés\u00a0; terminez d’abord quelques guidages.",
  "heading-unfit":
    "Une direction a besoin d’un angle et d’une incertitude de plus de 0",
  "incident-gone":
    "L’intervention {incident} n’est ni en cours ni la dernière clôturée",
  "incident-id-taken":
    "Une intervention a besoin de son propre identifiant, et non {incident}",
  "incident-not-among-open":
    "Il n’y a pas d’intervention en cours {incident}.",
  "incident-unknown":
    "Il n’y a pas d’intervention {incident}.",
  "incident-not-named":
    "Plusieurs interventions sont en cours\u00a0; nommez-en une dans incident_id\u00a0: {incidents}.",
  "incident-not-open":
    "Il n’y a pas d’intervention en cours {incident}",
  "incident-not-stored-yet":
    "L’intervention a été ouverte, mais la base de données ne l’a pas encore prise.",
  "incident-open-meanwhile":
    "Une intervention est en cours\u00a0; clôturez-la d’abord",
  "incident-still-open":
    "L’intervention «\u00a0{incident}\u00a0» est en cours\u00a0; clôturez-la d’abord",
  "incident-without-id":
    "Sans identifiant, aucune intervention n’est en cours",
  "incidents-several":
    "Plusieurs interventions sont en cours ({incidents})\u00a0; nommez-en une",
  "locate-over":
    "Aucun boîtier ne signale plus sa place par cet ordre",
  "locate-unknown":
    "Il n’y a pas de LOCATE {command} à arrêter",
  "message-empty":
    "Un message a besoin d’un texte",
  "no-open-incident":
    "Aucune intervention n’est en cours",
  "not-on-duty":
    "{name} n’est pas en service dans une intervention en cours",
  "nothing-to-undo":
    "Il n’y a pas de confirmation par radio à annuler sous cet identifiant",
  "number-not-finite":
    "Une coordonnée ou un angle n’est pas un nombre fini",
  "order-end-unknown":
    "Un ordre se termine par ALL_CLEAR ou END_ORDER",
  "order-not-repeatable":
    "Seul un ordre qui demande une réponse peut être renvoyé",
  "order-over":
    "Cet ordre est terminé\u00a0: donnez-en un nouveau",
  "order-unknown":
    "Il n’y a pas d’ordre {command} à renvoyer",
  "pin-gone":
    "Il n’y a pas de repère {pin}\u00a0; il a peut-être déjà été supprimé",
  "pin-incidents-differ":
    "Ces boîtiers sont dans des interventions différentes\u00a0: ils n’ont pas de lieu commun",
  "pin-meets-itself":
    "Un boîtier ne peut pas se rencontrer lui-même\u00a0: nommez-en deux",
  "pin-no-unit":
    "Aucun boîtier à placer\u00a0: nommez-en au moins un",
  "pin-of-another-kind":
    "Ce repère est d’un autre genre ({kind})\u00a0; supprimez-le, et posez-en un autre.",
  "pin-unknown":
    "Ce repère n’existe pas.",
  "pins-too-many":
    "Il y a place pour {most} repères, et non pour {wanted}\u00a0; supprimez-en d’abord",
  "place-no-numbers":
    "Le lieu n’est pas une paire de nombres",
  "place-too-far":
    "Le lieu est à {away_m} du bâtiment du plan\u00a0; au plus {most_m} ont un sens",
  "position-rate-not-finite":
    "Cette fréquence de positions n’est pas un nombre fini",
  "rescuer-is-member":
    "Le sauveteur est le membre lui-même\u00a0: nommez un autre sauveteur.",
  "rescuer-not-guided":
    "Ce sauveteur n’est pas guidé.",
  "start-uncertainty-negative":
    "Un départ a besoin d’incertitudes qui ne sont pas négatives",
  "uncertainty-unfit":
    "Une incertitude de {std_m} ne peut pas être pondérée\u00a0; dites de combien de mètres le lieu peut être faux, plus de 0",
  "unit-unknown":
    "Ce boîtier n’existe pas.",
  "unit-without-position":
    "{unit} n’a pas de position\u00a0: aucune n’a été reçue.",
  "incident-not-closed":
    "L’intervention n’est pas clôturée\u00a0: {alarms, plural, =0 {aucune alarme ouverte} one {# alarme ouverte} other {# alarmes ouvertes}}, {inside, plural, =0 {personne} one {# personne} other {# personnes}} à l’intérieur.",
  "rests-already":
    "{name} est déjà au repos",
  "works-already":
    "{name} est déjà au travail",
  "incident-time-unfit":
    "Le temps jusqu’au prochain {what, select, rest {repos} other {PAR}} est de {shortest_s} à {longest_s}",
  "order-answered":
    "{unit, select, everybody {Tous l’ont acquitté, ou ne l’ont} other {{unit} l’a acquitté, ou ne l’a}} jamais reçu",
  "pin-in-future":
    "L’heure du repère est de {ahead_s} dans le futur\u00a0; indiquez quand c’était",
  "pin-before-path":
    "L’heure du repère précède de {early_s} le début du parcours de {unit}\u00a0; il n’y a rien à repérer là",
  "fuser-unknown":
    "Cette version de Muster n’a pas de méthode de localisation «\u00a0{fuser}\u00a0»",
  "report-no-number":
    "Le rapport n’a pas de numéro\u00a0: donnez {part}, de 1 à {longest, number} caractères\u00a0; rien n’a été pris.",
  "report-json-unreadable": "Le contenu n’est pas un JSON lisible\u00a0: {error}.",
  "report-no-object": "Le contenu n’est pas un objet JSON\u00a0: envoyez un EIDO, ou un objet avec un numéro.",
  "alert-no-xml": "Le contenu n’est pas un XML accepté\u00a0: {error}.",
  "alert-no-cap": "Le contenu n’est pas une alerte CAP\u00a0: sa racine est «\u00a0{root}\u00a0».",
  "alert-no-id": "L’alerte n’a pas de {part}\u00a0; rien n’a été pris.",
  "alerts-not-taken": "Cette station ne prend pas d’alertes\u00a0: elle ne fait que relire.",
  "media-type-other": "Envoyez-le sous l’un de ces types\u00a0: {types} (en-tête Content-Type).",
};
