import type { Part } from "../catalogue";

export const role: Part<"role"> = {
  viewer: "observateur",
  commander: "commandant",
  administrator: "administrateur",
};

export const account: Part<"account"> = {
  title: "Connecté\u00a0: {name} ({role})",
  users: "Utilisateurs",
  log_out: "Se déconnecter",
  password: "Mot de passe",
  password_changed: "Le mot de passe est changé. Connectez-vous avec le nouveau.",
  old_password: "Ancien mot de passe",
  new_password: "Nouveau mot de passe, au moins 10 caractères",
  change_password: "Changer le mot de passe",
};

export const token: Part<"token"> = {
  title: "Jetons d’API",
  name: "Pour quel usage",
  role: "Rôle",
  days: "Jours de validité (vide\u00a0: toujours)",
  scopes: "Parties de la station (aucune choisie\u00a0: toutes)",
  make: "Créer un jeton",
  made: "Copiez-le maintenant, il ne sera plus montré\u00a0: {token}",
  token: "Jeton",
  may: "Droits",
  valid_until: "Valable jusqu’au",
  always: "toujours",
  all_parts: "toutes les parties",
  remove_question: "Les programmes qui l’utilisent n’ont plus accès.",
};

export const audit: Part<"audit"> = {
  title: "Journal d’audit",
  when: "Quand",
  who: "Qui",
  action: "Action",
  what: "Détail",
  older: "Entrées plus anciennes",
};

export const scope: Part<"scope"> = {
  accountability: "contrôle des effectifs",
  alarms: "alarmes",
  assignments: "affectations",
  audit: "audit",
  commands: "ordres",
  dispatch: "départs",
  enrolments: "enrôlements",
  exports: "exports",
  forgetting: "effacement",
  health: "état de la station",
  incidents: "interventions",
  live: "direct",
  people: "personnes",
  pins: "repères",
  radio: "radio",
  recordings: "enregistrements",
  replays: "relectures",
  samples: "mesures",
  site: "site",
  standby: "station de secours",
  tokens: "jetons",
  tracks: "traces",
  units: "boîtiers",
  users: "utilisateurs",
};

export const login: Part<"login"> = {
  not_the_same: "Les deux ne sont pas identiques\u00a0; saisissez de nouveau le nouveau mot de passe.",
  log_in: "Se connecter",
  user: "Utilisateur",
  generated:
    "Ce mot de passe a été généré par la station et il est écrit dans un fichier. Choisissez le vôtre avant de continuer.",
  again: "Nouveau mot de passe encore une fois",
  ended: "Cette session est terminée. Reconnectez-vous\u00a0: ce que vous faisiez est toujours là.",
  came_from: "Vous venez de la console de la station «\u00a0{station}\u00a0».",
  same_here: "{origin} Le même utilisateur et le même mot de passe sont valables ici.",
  press_ok: "{origin} Appuyez sur OK\u00a0: aucune alarme n’est audible ici avant.",
};
