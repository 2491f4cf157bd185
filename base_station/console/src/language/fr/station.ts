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
