import type { Part } from "../catalogue";

export const alarm: Part<"alarm"> = {
  open: "Alarmes en cours",
  none_open: "Aucune alarme en cours",
  count_open: "{count, number} en cours",
  fewer: "Moins",
  more: "+{count, number} autres",
  one_by_one: "Une par une",
  list: "Les lister",
  row: "L’alarme «\u00a0{text}\u00a0»",
  emergency: "Urgence",
  warning: "Alerte",
  advisory: "Information",
  priority: "Priorité {number}",
  acknowledged_by: "acquittée par {who}",
  not_acknowledged: "non acquittée",
  acknowledge: "Acquitter",
  resolve: "Clore",
  of_member: "Alarmes de {name}",
  none_open_of_member: "Aucune alarme en cours.",
  no_threshold:
    "Aucune mesure n’a franchi de seuil\u00a0: un bouton, un événement ou un silence l’a déclenchée.",
  thresholds: "Seuils à ce moment\u00a0: {thresholds}.",
  unit_unassigned: "personne ne porte ce boîtier maintenant",
  unit_of: "le boîtier est porté par {name} maintenant",
  by_other: "(porteur précédent)",
  of_person: "Alarmes en cours de cette personne",
  now: "maintenant {value}",
  last: "dernière valeur {value}",
  has_moved: "a bougé depuis",
  flood_at: "{what} à {time}",
  flood_from: "{what} de {from} à {to}",
  flood_par: "{count, number} PAR en retard",
  flood_off: "{count, number} boîtiers ont été éteints",
  flood_link: "{count, number} boîtiers ont perdu la liaison",
  flood_other: "{count, number} boîtiers\u00a0: {alarm},",
  of_incident: "{incident}\u00a0: {text}",
};

export const closing: Part<"closing"> = {
  open_alarms: "Alarmes en cours\u00a0: {names}.",
  inside: "À l’intérieur\u00a0: {names}.",
};
