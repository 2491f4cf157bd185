import type { Part } from "../catalogue";

export const common: Part<"common"> = {
  close: "Fermer",
  save: "Enregistrer",
  remove: "Retirer",
  no: "Non",
  ok: "OK",
  undo: "Annuler",
  yes: "Oui, {action}",
  about: "{action}\u00a0: {what}",
  show_on_plan: "Montrer sur le plan",
  hint: "{what}. {action}",
  name: "Nom",
  cannot_show: "{what}\u00a0: affichage impossible ({problem})",
  press_ignored: "La liste vient de changer\u00a0: l’appui a été ignoré. Appuyez à nouveau.",
  not_loaded: "Cette partie de la page n’a pas été chargée. Rechargez la page.",
};
