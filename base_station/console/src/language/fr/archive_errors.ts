/** Why an archive of incidents does not give or take what it is asked to, in French. */
import type { Part } from "../catalogue";

export const archive_error: Part<"archive_error"> = {
  "archive-bucket-away":
    "archive {archive}\u00a0: {what} pour l’instant ({error}). Rien n’est perdu\u00a0: réessayez quand le bucket répond",
  "archive-bucket-missing":
    "archive {archive}\u00a0: {what}\u00a0: ce bucket ou ce fichier n’existe pas\u00a0; créez le bucket ou vérifiez l’adresse",
  "archive-bucket-refuses":
    "archive {archive}\u00a0: {what}\u00a0: le compte de {credentials} n’en a pas le droit\u00a0; donnez-lui les droits de lister, lire, écrire et supprimer (s3:ListBucket, s3:GetObject, s3:PutObject, s3:DeleteObject)",
  "archive-cannot-list": "le contenu est illisible",
  "archive-cannot-read": "{file} est illisible",
  "archive-cannot-remove": "{file} ne peut pas être supprimé",
  "archive-cannot-write": "{file} ne peut pas être écrit",
  "archive-copy-gone":
    "la copie de {incident} n’est plus dans {archive}, et des parties de son journal manquent ici\u00a0: rapportez l’une ou l’autre",
  "archive-copy-incomplete":
    "{incident} a des personnes de {erased}, qui a été effacée, et sa copie ne dit pas lesquelles\u00a0: rapportez les segments manquants dans le journal, ou supprimez la copie",
  "archive-copy-lacks-file": "la copie de {incident} n’a pas de {file}\u00a0: copiez-la de nouveau",
  "archive-copy-older":
    "{incident} a des données plus récentes que sa copie dans {archive}, et des parties de son journal manquent ici\u00a0: la copie reste telle quelle. Rapportez les segments manquants dans le journal",
  "archive-copy-stays":
    "la copie de {incident} dans {archive} ne peut pas être refaite et reste telle quelle\u00a0: {reason}",
  "archive-disk-fails":
    "archive {archive}\u00a0: {what} ({error}). Vérifiez que le disque est là, a de la place et peut être utilisé par l’utilisateur de la station",
  "archive-entry-newer":
    "archive {place}\u00a0: écrit par une version plus récente de Muster ({version})\u00a0; utilisez celle-ci",
  "archive-entry-unreadable":
    "archive {place}\u00a0: illisible ({error})\u00a0; copiez l’intervention de nouveau, ou utilisez la version de Muster qui l’a écrite",
  "archive-fetched-differs":
    "archive {archive}\u00a0: {file} de {incident} n’est pas tel qu’il a été écrit, et {path} n’a pas été créé\u00a0: copiez de nouveau l’intervention tant que la station l’a",
  "archive-file-differs": "{file} n’est pas tel qu’il a été écrit\u00a0: copiez de nouveau l’intervention",
  "archive-file-missing":
    "{file} manque et devrait avoir {bytes, number} octets\u00a0: copiez de nouveau l’intervention",
  "archive-file-short": "{archive}\u00a0: {file} est plus court qu’avant\u00a0: copiez de nouveau l’intervention",
  "archive-file-size":
    "{file} a {there, number} octets et devrait en avoir {bytes, number}\u00a0: copiez de nouveau l’intervention",
  "archive-has-no-copy":
    "archive {archive}\u00a0: aucune des {count, number} interventions qui y ont été copiées n’y est. Vérifiez que c’est le bon disque ou bucket\u00a0; pour une nouvelle archive, donnez-lui un autre emplacement",
  "archive-has-none": "aucune",
  "archive-joined": "{first}. {others}",
  "archive-library-missing":
    "{archive} demande une bibliothèque qui n’est pas installée\u00a0: pip install --require-hashes -r deploy/requirements-archive.lock",
  "archive-log-nowhere":
    "le journal de {incident} n’est plus ici, et l’archive {archive} n’en a pas de copie complète\u00a0: vérifiez si elle a été déplacée",
  "archive-more":
    "{count, plural, one {# autre intervention ne peut pas non plus être copiée} other {# autres interventions ne peuvent pas non plus être copiées}}",
  "archive-no-address": "{archive}\u00a0: une archive est un dossier, ou s3://BUCKET/LIEU",
  "archive-no-bucket":
    "{archive} n’est pas un bucket\u00a0: donnez s3://BUCKET/LIEU, et {credentials} dans l’environnement",
  "archive-no-copy": "archive {archive}\u00a0: pas de copie complète de {incident}\u00a0; il y a\u00a0: {known}",
  "archive-no-folder": "ce dossier n’existe pas",
  "archive-not-kept": "archive {archive}\u00a0: {incident} n’a pas été conservée\u00a0: {reason}",
  "archive-not-written": "{archive}\u00a0: {reason}",
  "archive-of-another":
    "archive {archive}\u00a0: la copie de {incident} est d’une autre station\u00a0; donnez à chaque station son propre emplacement",
  "archive-replay-no-reason": "sans donner de raison",
  "archive-replay-not-started": "la relecture n’a pas commencé\u00a0: {reason}",
  "department-no-archive": "Il n’y a pas d’archive\u00a0: définissez location dans [archive].",
  "department-not-closed": "Aucune station n’a signalé que cette intervention est close.",
};
