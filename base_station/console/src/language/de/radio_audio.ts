import type { Part } from "../catalogue";

export const radio_audio: Part<"radio_audio"> = {
  title: "Funk",
  on: "Funk: an",
  off: "Funk: aus",
  channel: "Funkkanal",
  volume: "Lautstärke des Funks",
  too_fast: "Zu hören bei halber bis doppelter Geschwindigkeit",
  hear: "Anhören ({channel})",
};
