/** Refusals about people, units and enrolments, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_people: Part<"refusal_people"> = {
  "authority-elsewhere":
    "La clé de l’autorité est à la première station seulement\u00a0; enrôlez et renouvelez là-bas",
  "csv-columns-alike":
    "La ligne {line} du fichier a deux colonnes de même sens\u00a0: {first} et {second}\u00a0; supprimez-en une",
  "csv-empty":
    "Le fichier est vide",
  "csv-is-workbook":
    "Ce fichier est un classeur\u00a0; enregistrez-le en CSV dans le tableur, et envoyez celui-ci",
  "csv-line-unreadable":
    "La ligne {line} du fichier est illisible\u00a0: {error}\u00a0; cherchez un guillemet qui n’est pas fermé",
  "csv-no-names":
    "La ligne {line} du fichier ne nomme aucune colonne de noms\u00a0; la première ligne doit en avoir une appelée «\u00a0Name\u00a0» (ou «\u00a0First name\u00a0» et «\u00a0Last name\u00a0»), et peut avoir «\u00a0Crew\u00a0» et «\u00a0Role\u00a0»",
  "csv-nobody":
    "Le fichier a une ligne de noms de colonnes et personne en dessous",
  "csv-too-many":
    "Le fichier a plus de {most} personnes\u00a0; envoyez celles qui peuvent venir à une intervention, ou plusieurs fichiers",
  "enrolment-not-private":
    "Un enrôlement contient une clé privée, que d’autres sur le réseau pourraient lire en chemin\u00a0: servez la console par TLS, ou enrôlez sur la machine de la station.",
  "enrols-none":
    "Cette station n’enrôle pas de boîtiers maintenant\u00a0: elle ne fait que relire, ou démarre encore.",
  "members-none-named":
    "Aucun boîtier à affecter\u00a0: nommez-en au moins un",
  "members-without-units":
    "Aucun d’eux ne porte un boîtier enregistré\u00a0: attribuez d’abord un boîtier.",
  "name-of-two":
    "{name} est ici le nom de deux personnes",
  "no-authority":
    "Cette station n’a pas d’autorité de certification, et aucun boîtier ne peut être enrôlé\u00a0: créez-en une avec «\u00a0muster pki init\u00a0», et faites écouter le bus sur tls/.",
  "not-a-member":
    "{unit} n’est pas dans l’intervention {incident}.",
  "people-faulty":
    "Personne n’a été ajouté\u00a0: ligne {line}\u00a0: {fault}{more, plural, =1 {} other { (la première de # erreurs)}}",
  "person-unknown":
    "Cette personne n’existe pas.",
  "person-wears":
    "{name} porte {units}\u00a0; retirez-les d’abord",
  "photo-missing":
    "Il n’y a pas de photo de cette personne.",
  "photo-too-many-bytes":
    "La photo dépasse {most_mb}",
  "photo-unreadable":
    "La photo est illisible\u00a0; envoyez un fichier JPEG, PNG ou WebP",
  "still-enrolled":
    "{holder} {name} est enrôlé jusqu’au {until}\u00a0; renouvelez le certificat, ou révoquez-le s’il est perdu",
  "unit-not-listed":
    "Il n’y a pas de boîtier enregistré {unit}.",
  "unit-not-registered":
    "Il n’y a pas de boîtier enregistré «\u00a0{unit}\u00a0»\u00a0; enregistrez-le d’abord",
};
