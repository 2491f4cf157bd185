import type { Part } from "../catalogue";

export const station: Part<"station"> = {
  not_encrypted: "Nicht verschlüsselt: andere im Netz können mithören und senden",
};

export const forwarder: Part<"forwarder"> = {
  connected: "verbunden",
  connecting: "nicht verbunden",
  standby: "die andere Station leitet weiter",
  line: "{kind} {name} ({address}): {state}",
  sent: "{count, number} Ereignisse gesendet",
  received: "{count, number} empfangen",
  refused: "{count, number} ausgelassen",
};
