/** Warnings about imported files, by their codes, in French. */
import type { Part } from "../catalogue";

export const import_warning: Part<"import_warning"> = {
  "import-breaks-off": "il ne peut pas être lu jusqu’à la fin ({error})\u00a0: la suite est perdue",
  "import-far": "il commence à {away_km} du site de l’intervention",
  "import-incomplete": "le fichier est incomplet\u00a0: les noms des personnes et la fin sont perdus",
  "import-other-version":
    "{count, plural, one {un enregistrement n’a pas pu être lu} other {# enregistrements n’ont pas pu être lus}}\u00a0: écrit par une autre version de Muster",
  "import-part-damaged": "une partie est illisible\u00a0: {damage}",
  "import-places-left-out":
    "{count, plural, one {un lieu sans heure est ignoré} other {# lieux sans heure sont ignorés}}",
  "import-points-left-out":
    "{count, plural, one {un point sans lieu ou sans heure est ignoré} other {# points sans lieu ou sans heure sont ignorés}}",
  "import-time-of-fix":
    "son heure est celle de la position satellite de l’appareil\u00a0; elle a pu être prise plus tard",
  "import-unplaced":
    "{count, plural, one {une position} other {# positions}} d’avant la localisation du site\u00a0: ignorées",
};
