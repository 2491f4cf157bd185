import type { Part } from "../catalogue";

export const frame: Part<"frame"> = {
  link_state: "L’état de la connexion",
  stations_state: "L’état des deux stations",
  dispatch_offer: "La proposition d’un départ",
  replay: "La relecture",
  wall: "L’affichage mural",
  header: "L’en-tête",
  alarms: "La liste des alarmes",
  people: "La liste des personnes",
  plan: "Le plan",
  dialog: "Cette fenêtre",
  pass_device: "Muster complète un détecteur d’immobilité (PASS) certifié et ne le remplace jamais.",
  temperatures: "Les températures sont celles de l’environnement du boîtier, pas de la personne.",
  message: "Un message de la station",
};
