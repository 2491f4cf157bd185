import type { Part } from "../catalogue";

export const radio_audio: Part<"radio_audio"> = {
  title: "Radio",
  on: "Radio\u00a0: activée",
  off: "Radio\u00a0: désactivée",
  channel: "Canal radio",
  volume: "Volume de la radio",
  too_fast: "Audible de la moitié au double de la vitesse",
  hear: "Écouter ({channel})",
};
