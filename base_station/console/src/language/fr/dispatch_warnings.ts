/** Warnings about parts of a dispatch or an alert, by their codes, in French. */
import type { Part } from "../catalogue";

export const dispatch_warning: Part<"dispatch_warning"> = {
  "alert-circle-unreadable": "un cercle est illisible et est ignoré",
  "alert-expiry-far": "elle expire dans plus d’une semaine\u00a0; elle est affichée une semaine",
  "alert-expiry-unreadable":
    "«\u00a0expires\u00a0» n’est pas une heure avec fuseau\u00a0; l’alerte est affichée un jour",
  "alert-no-references": "elle ne nomme aucune alerte qu’elle met à jour ou annule",
  "alert-polygon-unreadable": "un polygone est illisible ou n’est pas fermé, et est ignoré",
  "alert-too-many-areas": "{count, number} zones au-delà des {most, number} premières sont ignorées",
  "alert-too-many-references": "seules les {most, number} dernières références sont suivies",
  "location-no-number": "{part} a une position qui n’est pas un nombre et est ignoré",
  "location-other-system": "{part} est en {system} et non en WGS-84, et est ignoré",
  "location-unreadable": "{part} est illisible ({error}) et est ignoré",
  "more-warnings": "{count, plural, one {un autre avertissement} other {# autres avertissements}}",
  "report-ended-no-flag": "«\u00a0ended\u00a0» n’est ni true ni false et est ignoré",
  "report-no-position": "{part} n’est pas une latitude et une longitude et est ignoré",
  "report-no-text": "{part} n’est pas un texte et est ignoré",
  "report-no-time": "{part} n’est pas une heure comme 2026-03-01T14:02:11+01:00 et est ignoré",
  "report-no-zone": "{part} n’a pas de fuseau horaire et est ignoré",
  "report-not-on-earth": "{part} ({lat_deg}, {lon_deg}) n’est pas un lieu sur la Terre et est ignoré",
  "report-place-elsewhere": "un lieu est donné par l’adresse d’un autre serveur et n’est pas récupéré",
  "report-place-of-call": "le lieu est celui de l’appel ({kind}), pas forcément celui de l’intervention",
  "report-position-no-object": "«\u00a0position\u00a0» n’est pas un objet avec lat_deg et lon_deg et est ignoré",
  "report-position-zero": "{part} vaut 0, 0, ce qui ne désigne aucun lieu, et est ignoré",
  "report-text-too-long": "{part} dépasse {longest, number} caractères et est tronqué",
  "report-time-ahead": "{part} ({value}) est à plus d’un jour dans le futur et est ignoré",
  "report-time-odd": "{part} ({value}) n’est pas plausible et est ignoré",
  "report-too-many-units": "{count, number} unités au-delà des {most, number} premières sont ignorées",
  "report-units-no-list": "«\u00a0units\u00a0» n’est pas une liste et est ignoré",
  "report-unknown-fields": "des champs inconnus sont ignorés\u00a0: {fields}",
};
