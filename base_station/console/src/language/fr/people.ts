import type { Part } from "../catalogue";

export const board: Part<"board"> = {
  title: "Tableau",
  print: "Imprimer",
  no_incident: "Aucune intervention en cours",
  summary: "{incident}, {count, number} sur place, {time}",
  not_current: "Pas à jour\u00a0: la station n’est pas connectée.",
  crew: "Binôme",
  unit: "Boîtier",
  state: "État",
  floor: "Étage",
  inside_for: "À l’intérieur depuis",
  floor_unknown: "inconnu",
};

export const radio: Part<"radio"> = {
  in_alarm: "En alarme\u00a0: {members}. {question}",
  yes: "Oui, répondu par radio",
};

export const headcount: Part<"headcount"> = {
  title: "Effectif",
  on_scene: "Sur place",
  inside: "À l’intérieur",
  outside: "À l’extérieur",
  rehab: "Repos",
  not_located: "Non localisé",
  never_heard: "Jamais reçu",
};

export const card: Part<"card"> = {
  to_plan: "Aller à cette personne sur le plan",
  timeline: "Chronologie",
  reasons: "{count, plural, one {Motif de l’alarme} other {Motifs des alarmes}}",
  unassigned: "non affecté",
  unknown_unit: "boîtier inconnu",
  unreliable: "Position non fiable",
  uncertain: "Position incertaine",
  reason: "{what}\u00a0: {reason}",
  cannot_be_notified: "ne peut pas être prévenu",
  cannot_be_notified_hint: "Le boîtier n’a pas de sortie\u00a0: utiliser la radio",
  preflight: "Boîtier {state}",
  duplicate: "Identifiant de boîtier en double\u00a0: {reason}",
  unregistered: "Boîtier non enregistré\u00a0: journalisé, non utilisé.",
  register: "Enregistrer",
  actions: "Pour {name}",
  par_by_radio: "PAR par radio",
  has_answered: "{name} a répondu par radio\u00a0?",
  return_to_duty: "Retour en service",
  to_rehab: "Au repos",
  correct_position: "Corriger la position …",
  same_place: "Au même endroit que …",
  locate: "Signal de localisation",
  locate_asks: "Signal de localisation …",
  message: "Message",
  members_down: "Personnes en détresse",
  words: "{name}\u00a0: {words}",
  not_located: "non localisé",
  no_position: "pas encore de position",
  old_place: "{place}, ancienne",
  assign_incident: "Affecter à cette intervention",
};

export const fact: Part<"fact"> = {
  position: "Position",
  not_updated: "Pas à jour",
  environment: "Environnement",
  electronics: "Électronique",
  battery: "Batterie",
  battery_low: "faible",
  sensors: "Capteurs",
  in_rehab: "Au repos depuis",
};

export const list: Part<"list"> = {
  by_need: "Par urgence",
  by_crew: "Par binôme",
  by_name: "Par nom",
  title: "Liste des personnes",
  placeholder: "Nom, boîtier ou binôme  ( / )",
  search: "Chercher par nom, boîtier ou binôme",
  order: "Ordre de la liste",
  lines: "Une ligne chacun",
  board: "Tableau",
};

export const confirmation: Part<"confirmation"> = {
  not_yet_confirmed: "pas encore confirmé",
  confirmed_by_unit: "confirmé à {time} par son boîtier",
  confirmed_by_radio: "confirmé à {time} par radio, saisi par {who}",
  undo_par: "PAR de {whom}\u00a0: confirmé par radio",
  undo_answer: "{whom}\u00a0: répondu par radio",
};
