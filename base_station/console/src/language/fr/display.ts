import type { Part } from "../catalogue";

export const display: Part<"display"> = {
  title: "Affichage",
  theme: "Thème",
  theme_system: "Comme cet appareil",
  theme_light: "Clair",
  theme_dark: "Sombre",
  theme_red: "Lumière rouge",
  language: "Langue",
  language_browser: "Comme ce navigateur",
  language_missing:
    "Les textes de cette langue ne sont pas encore arrivés de la station\u00a0; elle est redemandée.",
  units: "Unités",
  units_metric: "Métriques\u00a0: m, °C",
  units_imperial: "Impériales\u00a0: pi, °F",
  floors: "Étages",
  floors_european: "Européens\u00a0: rez-de-chaussée, étage 1",
  floors_american: "Américains\u00a0: 1er étage, 2e étage",
  wall: "Affichage mural",
  wall_use: "Noms, état et étage, lisibles à 2 m",
  gloves: "Gants",
  gloves_use: "Grandes cibles (15 mm)",
  plan_marks: "Signes sur le plan",
  shortcuts: "Raccourcis clavier",
  shortcuts_use: "Les utiliser",
  speech: "Alarmes parlées",
  speech_use: "Annoncer chaque urgence et alerte après sa tonalité",
  speech_impossible: "Ce navigateur ne peut pas parler.",
};

export const language_name: Part<"language_name"> = {
  en: "English",
  de: "Deutsch",
  fr: "Français",
};

export const shortcut: Part<"shortcut"> = {
  evacuate: "Évacuation\u00a0: ouvre l’ordre, n’envoie encore rien",
  par: "PAR\u00a0: ouvre la demande, n’envoie encore rien",
  next_alarm: "Alarme suivante\u00a0: montre la personne sur le plan",
  all_alarms: "Toutes les alarmes, et ce qu’il en est advenu",
  section: "Coupe du bâtiment à la place du plan, et retour",
  search: "Chercher dans la liste des personnes",
  help: "Cette liste",
};
