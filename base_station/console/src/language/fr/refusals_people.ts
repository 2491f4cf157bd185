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
  "picture-too-many-pixels":
    "{kind, select, map {la carte} other {la photo}} a plus de {most, number} millions de pixels\u00a0; réduire et envoyer à nouveau",
  "photo-unreadable":
    "La photo est illisible\u00a0; envoyez un fichier JPEG, PNG ou WebP",
  "still-enrolled":
    "{holder} {name} est enrôlé jusqu’au {until}\u00a0; renouvelez le certificat, ou révoquez-le s’il est perdu",
  "unit-not-listed":
    "Il n’y a pas de boîtier enregistré {unit}.",
  "unit-not-registered":
    "Il n’y a pas de boîtier enregistré «\u00a0{unit}\u00a0»\u00a0; enregistrez-le d’abord",
  "clock-before-authority":
    "L’horloge de cette machine est au {today}, et l’autorité commence le {begin}\u00a0: réglez d’abord l’horloge",
  "certificate-outlives-authority":
    "Le certificat durerait plus que son autorité, qui finit le {end}\u00a0; demandez moins de jours, ou créez une nouvelle autorité et enrôlez de nouveau tout le monde",
  "authority-key-of-another":
    "La clé de l’autorité ne correspond pas à son certificat",
  "authority-key-damaged":
    "La clé de l’autorité est endommagée\u00a0; restaurez-la de sa sauvegarde",
  "certificate-name-unfit":
    "«\u00a0{name}\u00a0» ne convient pas à un certificat\u00a0: prenez de 1 à 64 caractères",
  "not-enrolled":
    "Il n’y a pas de certificat pour {holder} {name}\u00a0; {enrolled}",
  "enrolled-are":
    "sont enrôlés {names}",
  "enrolled-none":
    "personne n’est enrôlé",
  "key-file-missing":
    "{path} manque\u00a0; remettez-le, ou restaurez une sauvegarde",
  "registry-damaged":
    "{path} est endommagé ({error})\u00a0; restaurez-le d’une sauvegarde",
  "registry-missing":
    "{path} manque\u00a0; restaurez-le d’une sauvegarde, ou déplacez son dossier",
  "authority-missing":
    "{folder} n’est pas une autorité de certification\u00a0; créez-en une avec «\u00a0muster pki init\u00a0»",
  "station-certificate-unusable":
    "{folder}/station.pem et station.key sont inutilisables ({error})\u00a0; créez-en de nouveaux avec «\u00a0muster pki renew-station\u00a0»",
  "csv-person-twice": "{name} figure déjà à la ligne {line, number}\u00a0; distinguez les deux par leurs noms",
  "csv-name-missing": "le nom manque",
  "csv-text-faulty": "{field} dépasse {most, number} lettres, ou n’est pas en lettres simples",
  "csv-person-ambiguous": "{name} est ici le nom de deux personnes\u00a0; renommez d’abord l’une d’elles",
};
