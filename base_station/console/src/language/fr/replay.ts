import type { Part } from "../catalogue";

export const replay: Part<"replay"> = {
  title: "Relecture",
  word: "RELECTURE",
  what: "{incident}, {time} {zone}. Enregistré, pas en direct.",
  accuracy: "Rapport de précision",
  first: "Retour à la première relecture",
  live: "Retour au direct",
  flaws: "Tout n’est pas comme alors\u00a0: {count, number}",
  gap: "Pas d’enregistrement de {from} à {until}",
  gap_shown: "Les dernières positions d’avant sont affichées.",
  no_alarms: "En direct\u00a0: aucune alarme ouverte",
  alarms:
    "{count, plural, one {En direct\u00a0: # alarme ouverte} other {En direct\u00a0: # alarmes ouvertes}}",
  station: "Station\u00a0: {problem}",
};

export const transport: Part<"transport"> = {
  alarm_before: "Alarme précédente",
  alarm: "Alarme",
  back: "Reculer de {time}",
  pause: "Pause",
  play: "Lecture",
  on: "Avancer de {time}",
  next_alarm: "Alarme suivante",
  going: "Vers {time}…",
  progress: "{at} sur {all}",
  go_to: "Aller à une alarme",
  alarms_unknown: "Alarmes …",
  no_alarms: "Aucune alarme",
  alarms: "{count, plural, one {# alarme…} other {# alarmes…}}",
  speed: "Vitesse",
  time: "Temps de l’intervention",
};

export const timeline: Part<"timeline"> = {
  title: "Chronologie de {name}",
  span: "{from} à {until}, {date}.",
  hint: "Gris\u00a0: pas de contact radio. Tirer sur une ligne pour agrandir.",
  hint_replay: "Appuyer sur une ligne pour y aller dans la relecture.",
  reading: "La station lit son journal…",
  time: "Temps affiché",
  earlier: "Avant",
  later: "Après",
  zoom_in: "Agrandir",
  zoom_out: "Réduire",
  all: "Tout",
  until_now: "Jusqu’à maintenant",
  values_at: "Valeurs à {time}",
  replay: "Relire à partir d’ici",
  strip: "{title}\u00a0: {values}",
  no_values: "aucune valeur",
  unknown: "inconnu",
  temperature_degc: "Température",
  height_m: "Hauteur",
  floor: "Étage",
  activity: "Activité",
  battery: "Batterie",
  position_error_m: "Erreur de position annoncée (DRMS)",
  silence_s: "Liaison\u00a0: temps sans message",
  range: "{low} à {high}",
};

export const crossing: Part<"crossing"> = {
  sentence: "À {time}, {series} valait {value}, au-delà du seuil «\u00a0{threshold}\u00a0» ({limit}).",
  motionless_s: "temps sans mouvement",
  temperature_degc: "température",
  battery: "batterie",
  threshold: "{name} {value}",
};
