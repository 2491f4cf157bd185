import type { Part } from "../catalogue";

export const station: Part<"station"> = {
  not_encrypted: "Non chiffré\u00a0: d’autres sur le réseau peuvent écouter et émettre",
};

export const forwarder: Part<"forwarder"> = {
  connected: "connecté",
  connecting: "non connecté",
  standby: "l’autre station transmet",
  line: "{kind} {name} ({address})\u00a0: {state}",
  sent: "{count, number} événements envoyés",
  received: "{count, number} reçus",
  refused: "{count, number} ignorés",
};

export const health: Part<"health"> = {
  title: "État de la station de base",
  ok: "Station de base en ordre",
  unknown: "État de la station de base inconnu",
  light: "Station de base\u00a0: {sentence} {others}",
  messages: "Messages reçus",
  messages_per_s: "Messages par seconde",
  undecodable: "Messages illisibles",
  duplicates: "Doublons",
  unknown_units: "Boîtiers inconnus",
  recorded: "Enregistré",
  disk_free: "Espace disque libre",
};

export const connection: Part<"connection"> = {
  connected: "Connecté",
  connected_to: "Connecté à {station}",
  lost: "Connexion perdue",
  connecting: "Connexion en cours",
  picture_from: "Cette image date de {time} et n’est pas mise à jour.",
  trying: "Nouvelle tentative de connexion.",
  nothing_updated: "Rien n’est mis à jour ici.",
  lost_since: "Connexion à la station perdue {age}.",
  unreachable: "La station de base est injoignable.",
  outcome_unknown: "Pas de réponse de la station de base. Vérifiez si l’ordre est parti avant de le répéter.",
  answered: "La station a répondu {status, number}.",
  carried_out: "Ce qui était sans réponse a été exécuté à {time}.",
  not_carried_out: "Ce qui était sans réponse n’a pas été exécuté. Redonnez l’ordre s’il est toujours voulu.",
  title_lost: "PAS DE CONNEXION – Muster",
  title_replay: "Relecture – Muster",
  title_alarms: "({count, number}!) Muster",
};

export const systems: Part<"systems"> = {
  title: "Autres systèmes",
  label: "Transmissions",
};

export const archive: Part<"archive"> = {
  line: "Archive {location}\u00a0: {state}",
  waiting: "reçoit les interventions closes",
  copying: "une intervention est copiée",
  away: "injoignable",
  incidents: "{count, plural, one {# intervention attend} other {# interventions attendent}}",
  last: "la dernière {time}",
};
