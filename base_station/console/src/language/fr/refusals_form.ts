/** Refusals about the form of a request and its fields, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_form: Part<"refusal_form"> = {
  "field-fault":
    "{field}\u00a0: {fault}",
  "faults-joined":
    "{before}\u00a0; {last}",
  "field-integer":
    "doit être un nombre entier",
  "field-integer-too-large":
    "doit être un nombre entier, et moins grand",
  "field-number":
    "doit être un nombre",
  "field-not-finite":
    "doit être un nombre fini",
  "field-truth":
    "doit être true ou false",
  "field-list":
    "doit être une liste",
  "field-object":
    "doit être un objet JSON",
  "field-missing":
    "manque\u00a0; remplissez ce champ",
  "field-not-known":
    "n’est pas connu ici\u00a0; omettez-le",
  "field-text":
    "doit être un texte",
  "field-empty":
    "est vide\u00a0; remplissez ce champ",
  "field-target":
    "doivent être un boîtier, un binôme, un étage ou tous",
  "field-choice":
    "doit être l’un de ceux-ci\u00a0: {allowed}",
  "field-too-short":
    "est trop court\u00a0; donnez au moins {least, number} caractères",
  "field-too-long":
    "est trop long\u00a0; donnez au plus {most, number} caractères",
  "field-entries-too-few":
    "a trop peu d’éléments\u00a0; donnez-en au moins {least, number}",
  "field-entries-too-many":
    "a trop d’éléments\u00a0; donnez-en au plus {most, number}",
  "field-not-above":
    "doit être supérieur à {limit}",
  "field-too-low":
    "doit être d’au moins {least}",
  "field-not-below":
    "doit être inférieur à {limit}",
  "field-too-high":
    "doit être d’au plus {most}",
  "field-one-line":
    "doit être une ligne de caractères simples",
  "field-name":
    "doit être une ligne de caractères simples, et non vide",
  "field-id":
    "doit avoir de 1 à 128 lettres, chiffres et _.:-",
  "field-key":
    "doit avoir de 1 à 128 lettres, chiffres et signes sans espace, entre guillemets ou non",
  "field-alarm-id":
    "doit avoir de 1 à 200 lettres, chiffres, espaces et _.:@-",
  "field-unit-id":
    "doit avoir de 1 à 64 lettres, chiffres et _.-, en commençant par une lettre ou un chiffre",
  "field-unit-id-or-none":
    "doit avoir de 1 à 64 lettres, chiffres et _.-, en commençant par une lettre ou un chiffre\u00a0; ou être vide",
  "body-too-large":
    "C’est trop grand\u00a0: une image, un plan ou une carte peut avoir {upload_mb}, des mesures {samples_mb}, un départ ou une alerte {dispatch_mb}, tout le reste {other_mb}.",
  "no-such-address":
    "Cette adresse n’existe pas.",
  "method-not-answered":
    "{method} n’est pas accepté à cette adresse\u00a0; utilisez\u00a0: {allowed}.",
  "body-json":
    "Envoyez un objet JSON comme contenu, avec l’en-tête Content-Type: {type}",
  "body-file":
    "Envoyez le fichier lui-même comme contenu, avec l’en-tête Content-Type: {type} ou semblable",
};
