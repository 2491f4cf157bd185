import type { Part } from "../catalogue";

export const anchor: Part<"anchor"> = {
  title: "Position du plan",
  align: "Caler par deux points",
  first_point: "Premier point",
  second_point: "Second point",
  point: "{point}\u00a0: {where}",
  click: "cliquer sur le plan",
  latitude: "Latitude, °",
  hint: "Prenez deux angles éloignés. Une carte ou un récepteur GPS indique où ils sont.",
  hint_map:
    "Prenez deux angles éloignés. Cliquez les deux mêmes, dans le même ordre, sur le plan et sur la carte.",
  save: "Enregistrer la position",
  too_near:
    "Les points sont à {plan} l’un de l’autre sur le plan et à {earth} sur la Terre\u00a0: prenez-en deux plus éloignés.",
  wrong_point:
    "Les points sont à {plan} l’un de l’autre sur le plan et à {earth} sur la Terre\u00a0: l’un des deux est un autre point, ou l’échelle du plan est fausse.",
  moves: "sur le plan, les personnes localisées par satellite se déplacent de {distance}",
  turns: "sur le plan, les personnes localisées par satellite tournent de {angle}",
  moves_and_turns:
    "sur le plan, les personnes localisées par satellite se déplacent de {distance} et tournent de {angle}",
  height: "l’altitude change de {distance}",
  change: "Le plan a une position\u00a0: {place}. Avec la nouvelle, {change}.",
  change_two: "Le plan a une position\u00a0: {place}. Avec la nouvelle, {change}, et {other}.",
  place: "{latitude}, {longitude}, son nord vers {heading}",
};

export const base_map: Part<"base_map"> = {
  done: "Le fond de carte est en place.",
  none: "Il n’y en a pas.",
  some: "Il y en a un.",
  not_world_file: "Un fichier de géoréférencement contient six nombres, un par ligne.",
  picture: "Image (PNG, JPEG ou WebP)",
  world_file: "Fichier de géoréférencement (.pgw, .jgw, .tfw ou .wld)",
  epsg: "Numéro EPSG (vide\u00a0: degrés ou carte web)",
  set: "Mettre le fond de carte",
  remove: "Retirer le fond de carte",
  remove_question: "Retirer la carte pour tout le monde\u00a0?",
};

export const beacon: Part<"beacon"> = {
  title: "Balise",
  new: "Une balise est ici",
  number: "Son numéro",
  not_passed: "Aucun boîtier n’est encore passé devant.",
  passed: "Un boîtier est passé devant il y a {age}.",
  reach: "Détectée à partir de, {unit}",
  place: "Placer la balise",
  save: "Enregistrer la balise",
  remove: "Retirer la balise",
  remove_question: "Plus personne n’est localisé par elle en passant.",
};

export const plan: Part<"plan"> = {
  contents:
    "{name}\u00a0: {floors, plural, one {# étage} other {# étages}}, {rooms, plural, one {# pièce} other {# pièces}}, {shapes, plural, one {# forme} other {# formes}}",
  unnamed: "plan sans nom",
  in_room: "dans {room}",
  near_room: "près de {room}",
  feature: "L’élément {number} du plan",
  floor_picture: "L’image de cet étage",
  unit: "{unit} sur le plan",
  colours: "Les couleurs du plan",
  scale: "L’échelle du plan",
  building: "Le bâtiment",
  pins: "Les repères sur le plan",
  trails: "Les traces sur le plan",
  way: "Le chemin sur le plan",
  others: "Les autres équipes sur le plan",
  paper: "Feuille\u00a0: les flèches déplacent la croix, Entrée place un point",
  outside_view: "En danger, hors de la vue",
  show: "Montrer {name}",
  show_outside: "Montrer {name}, hors de la vue vers {direction}",
  floor_shown: "Étage affiché",
  all_floors: "Tous",
  floor_label: "Étage {floor},",
  floors_label: "Étages\u00a0: {floor},",
  in_danger_of: "en danger, sur",
  people: "{count, plural, one {personne} other {personnes}}",
};

export const compass: Part<"compass"> = {
  n: "le nord",
  ne: "le nord-est",
  e: "l’est",
  se: "le sud-est",
  s: "le sud",
  sw: "le sud-ouest",
  w: "l’ouest",
  nw: "le nord-ouest",
};

export const trail: Part<"trail"> = {
  fused: "Trace en direct",
  raw: "À l’estime seulement",
  smoothed: "Post-traitée",
  title: "Traces",
  loading: "calcul en cours …",
  hint_all: "Les cinq dernières minutes. Choisissez une personne pour comparer toutes ses traces.",
  hint_chosen: "Celles de la personne choisie depuis le début, si d’autres que la première sont dessinées.",
};

export const mark: Part<"mark"> = {
  pin: "Repère\u00a0: {name}, {when}",
  start: "départ",
  emergency: "URGENCE {name}",
  other_team: "{name} ({source})",
};
