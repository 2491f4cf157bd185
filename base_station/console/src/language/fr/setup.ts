import type { Part } from "../catalogue";

export const crew: Part<"crew"> = {
  title: "Binômes",
  hint:
    "Glissez une personne vers un autre binôme, ou choisissez des personnes puis {move}. Déposez une image sur une personne pour sa photo.",
  move_here: "Déplacer ici",
  new: "Nouveau binôme",
  add: "Ajouter le binôme",
  none: "Sans binôme",
  count: "{crew}\u00a0: {count, number}",
};

export const enrolment: Part<"enrolment"> = {
  title: "Enrôlements",
  unit: "Boîtier",
  until: "Enrôlé jusqu’au",
  renew: "Renouveler",
  renew_question:
    "{unit} reçoit un nouveau certificat, et l’ancien reste valable jusqu’à sa fin. Un boîtier perdu est révoqué à la place.",
  none: "Aucun boîtier n’est encore enrôlé.",
  unit_id: "Identifiant du boîtier",
  enrol: "Enrôler le boîtier",
  of: "Enrôlement de {unit}",
  made:
    "Enrôlement de {unit}, valable jusqu’au {time}. Il n’est montré que cette fois, et qui le possède est {name}\u00a0: photographiez-le pour ce boîtier seulement, et n’en gardez pas de copie.",
  save: "Enregistrer en fichier",
  carry: "Portez-le sur le boîtier et effacez-le ici. Là-bas\u00a0: {command}",
  photo: "Avec une photo du code, sur le boîtier\u00a0: {command}",
  as_text: "En texte, à enregistrer en fichier sur le boîtier",
  done: "Terminé",
  done_question: "Il ne pourra plus être montré. Le boîtier l’a-t-il\u00a0?",
  done_yes: "Oui, il l’a",
  qr_code: "Code QR de l’enrôlement de {unit}",
};

export const draft: Part<"draft"> = {
  unit: "Unité de longueur",
  unit_of_file: "comme dans le fichier",
  page: "Page",
  page_of: "{page, number} sur {all, number}",
  contents: "Ce fichier\u00a0: {contents}.",
  use_place: "Reprendre la position sur la Terre du fichier\u00a0: {place}",
};

export const erase: Part<"erase"> = {
  delete: "Effacer …",
  delete_of: "Effacer … {name}",
  warning: "{warning} C’est définitif\u00a0; le journal d’audit garde la trace de l’effacement.",
  type_name: "Saisir «\u00a0{name}\u00a0» pour confirmer",
  delete_permanently: "Effacer définitivement",
  deleting: "Effacement de {name}",
  nothing_deleted: "Rien n’a été effacé\u00a0: {problem}.",
  deleted: "{count, plural, one {# enregistrement retiré} other {# enregistrements retirés}} du journal.",
  deleted_but: "{deleted} {problem}.",
};
