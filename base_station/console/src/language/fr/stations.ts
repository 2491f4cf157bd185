import type { Part } from "../catalogue";

export const sound: Part<"sound"> = {
  off: "Son coupé",
  on: "Son activé",
  blocked: "Pas encore de son",
  heard: "Les alarmes s’entendent",
  press: "Appuyer pour entendre les alarmes",
};

export const standby: Part<"standby"> = {
  title: "Station de secours",
  is_standby: "{station} est la station de secours.",
  waits: "Elle attend l’autre station et ne dirige pas.",
  other_leads: "{other} dirige. Ici on regarde\u00a0; les changements se font là-bas.",
  behind: "Elle n’est pas encore à jour\u00a0: l’affichage peut être ancien.",
  reading: "Lecture du journal",
  reading_share: "La station lit son journal\u00a0: {share}.",
  reading_hint:
    "Voici le dernier état stocké\u00a0: rien n’est en direct et rien ne peut encore être changé. Les boîtiers continuent seuls et leurs messages seront récupérés.",
  open_other: "Ouvrir la console de {other}",
  take_over: "Prendre la main",
  take_over_question: "{station} dirige désormais.",
};

export const away: Part<"away"> = {
  title: "Station injoignable",
  hint:
    "La station ne répond pas à {host}. Rien n’est affiché, car rien de ce que cette page sait n’est à jour. Utiliser la radio.",
  tried:
    "Essais depuis {time}, pendant {duration}. La console s’affichera d’elle-même dès que la station répondra.",
  again: "Réessayer maintenant",
};

export const waiting: Part<"waiting"> = {
  asking: "Demande à la station…",
  sending: "Envoi…",
};

export const wall: Part<"wall"> = {
  no_incident: "Aucune intervention ouverte",
  inside: "{count, number} à l’intérieur",
  leave: "Quitter l’affichage mural",
  people: "Personnel",
  more_well: "+{count, number} autres, personne en détresse",
  more: "+{count, number} autres, dont {needing, number} en détresse",
  unassigned: "Non affecté",
  elsewhere: "{incident}\u00a0: {words}",
};
