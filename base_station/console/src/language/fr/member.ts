import type { Part } from "../catalogue";

export const activity: Part<"activity"> = {
  unknown: "Inconnue",
  still: "Immobile",
  walking: "Marche",
  running: "Court",
  stairs_up: "Monte l’escalier",
  stairs_down: "Descend l’escalier",
  crawling: "Rampe",
  lying: "Allongé",
  falling: "Chute",
};

export const posture: Part<"posture"> = {
  upright: "Redressé",
  standing: "Debout",
  sitting: "Assis",
  kneeling: "À genoux",
  crawling: "À quatre pattes",
  bent: "Penché en avant",
  lying: "Allongé",
  prone: "Allongé sur le ventre",
  supine: "Allongé sur le dos",
  left_side: "Allongé sur le côté gauche",
  right_side: "Allongé sur le côté droit",
};

export const mobility: Part<"mobility"> = {
  backward: "recule",
  leftward: "pas vers la gauche",
  rightward: "pas vers la droite",
  turning: "tourne sur place",
};

export const link: Part<"link"> = {
  live: "Liaison bonne",
  stale: "Liaison intermittente",
  lost: "Liaison perdue",
  never: "Jamais reçu",
  switched_off: "Éteint",
};

export const heat: Part<"heat"> = {
  normal: "normale",
  caution: "attention",
  warning: "alerte",
  critical: "CRITIQUE",
};

export const battery: Part<"battery"> = {
  charging: "en charge",
  external: "sur alimentation externe",
};

export const member: Part<"member"> = {
  no_status: "Aucun état",
  mayday: "MAYDAY",
  motionless: "{activity}, sans mouvement depuis {age}",
  posture: "{posture} ({confidence})",
  preflight_failed: "pas prêt\u00a0: {text}",
  preflight_warning: "avec des avertissements\u00a0: {text}",
  place_unknown: "emplacement inconnu",
  recognised: "reconnu",
  was_inside: "Était à l’intérieur",
  inside_for: "Entré il y a",
  duplicate: "deux boîtiers émettent sous ce nom, l’un est masqué",
  gps_none: "pas encore de position",
  gps_used: "utilisé",
  gps_unused: "non utilisé\u00a0: {reason}",
};

export const worn: Part<"worn"> = {
  foot: "pied",
  left_foot: "pied gauche",
  right_foot: "pied droit",
  leg: "jambe",
  upper_body: "haut du corps",
  shank: "tibia",
  thigh: "cuisse",
  pocket: "poche",
  hip: "hanche",
  waist: "taille",
  lower_back: "bas du dos",
  torso: "buste",
  chest: "poitrine",
  hand: "main",
};

/** What makes positions of the samples, by its name in the unit. */
export const tracker: Part<"tracker"> = {
  eskf: "position d’après les foulées du pied",
  huang: "position d’après les foulées du pied (Huang)",
  waist: "position d’après les pas à la taille",
  hip: "position d’après les pas à la hanche",
  "hip-corridors": "position d’après les pas à la hanche, dans des couloirs droits",
  body: "position d’après les pas du corps",
  torso_shank: "position d’après le torse et le mollet",
  two_feet: "position d’après les deux pieds",
  foot_and_trunk: "position d’après le pied et le tronc",
};
