/** Notes on a drawing that was read, by the codes of their sentences, in French. */
import type { Part } from "../catalogue";

export const drawing_note: Part<"drawing_note"> = {
  "note-columns": "poteaux",
  "note-doors": "portes",
  "note-dxf-no-walls": "Aucun calque ne porte le nom de murs\u00a0: chaque ligne est prise pour un mur.",
  "note-dxf-unit": "Son unité de longueur est {unit}\u00a0; son coin inférieur gauche est à l’origine.",
  "note-features-left-out":
    "{count, plural, one {# objet est un point ou sans utilité pour un plan, et a été omis.} other {# objets sont des points ou sans utilité pour un plan, et ont été omis.}}",
  "note-floors": "Ses étages\u00a0: {floors}.",
  "note-left-out": "Omis\u00a0: {elements}\u00a0: {count, number}.",
  "note-lifts": "ascenseurs",
  "note-no-class": "éléments sans classe",
  "note-no-passage": "{elements} sans porte qui sont trop petites, ou commencent au-dessus du sol",
  "note-no-place": "Sans position sur la Terre\u00a0: l’aligner par deux points.",
  "note-no-walls": "Sans murs\u00a0: les pièces sont dessinées, et les trajets peuvent les traverser.",
  "note-not-cut": "{elements} absents à {cut_m} au-dessus d’un sol",
  "note-openings": "ouvertures",
  "note-other-grid": "Sa position est donnée dans la grille {grid}, pas en UTM.",
  "note-outside-zone": "Sa position en {grid} est hors de cette zone.",
  "note-rooms": "pièces",
  "note-stairs": "escaliers",
  "note-storeys-left-out": "Les niveaux sans portes, pièces ni escaliers sont omis\u00a0: {names}.",
  "note-suggested":
    "Sa position sur la Terre est celle de son site, que beaucoup de logiciels de dessin fixent d’eux-mêmes\u00a0: la regarder avant de l’utiliser.",
  "note-too-low": "{elements} de moins de {steps_m}",
  "note-walls": "murs",
  "note-without-shape": "{elements} sans forme",
};
