import type { Part } from "../catalogue";

export const alarm_text: Part<"alarm_text"> = {
  mayday: "Mayday\u00a0: {who}",
  fall: "{who}\u00a0: chute possible",
  "no-motion": "{who}\u00a0: immobile depuis {duration}",
  "par-overdue": "{who}\u00a0: PAR en retard, pas confirmé depuis {minutes}",
  "par-overdue-unanswered": "{who}\u00a0: PAR en retard, sans réponse depuis {minutes}",
  "par-overdue-unconfirmed": "{who}\u00a0: PAR en retard, pas encore confirmé, engagé depuis {minutes}",
  "par-overdue-no-answer-yet": "{who}\u00a0: PAR en retard, sans réponse, engagé depuis {minutes}",
  heat: "{who}\u00a0: équipement à {temperature}, limite de chaleur utilisée à {heat}",
  "heat-limit": "{who}\u00a0: limite de chaleur de l’équipement atteinte, panne possible",
  "heat-limit-late":
    "{who}\u00a0: limite de chaleur de l’équipement atteinte il y a quelque temps d’après sa mémoire, panne possible",
  "battery-low": "{who}\u00a0: batterie du boîtier à {battery}",
  "signal-lost": "{who}\u00a0: signal perdu depuis {duration}",
  "unit-off": "{who}\u00a0: boîtier éteint",
  "tracker-unsure": "{who}\u00a0: localisation du boîtier incertaine ({reasons})",
  "tracker-lost": "{who}\u00a0: localisation du boîtier perdue ({reasons})",
  "agent-silent":
    "{who}\u00a0: pas localisé, l’agent de {unit_id} ne répond plus\u00a0; le démarrer, la position affichée est ancienne",
  "agent-never-started":
    "{who}\u00a0: pas localisé, l’agent de {unit_id} n’a pas démarré\u00a0; le démarrer, la position affichée est ancienne",
  "not-on-foot":
    "{who}\u00a0: boîtier pas porté au pied, position fausse tant qu’il n’est pas fixé sur le cou-de-pied",
  "position-lost": "{who}\u00a0: position perdue (à {radius} près)",
  "position-lost-tracker": "{who}\u00a0: position perdue (localisation du boîtier perdue\u00a0: {reasons})",
  "gps-unused": "{who}\u00a0: GPS non utilisé ({reasons})",
  "unit-fault": "{who}, boîtier\u00a0: {fault}",
  "agent-fault": "{who}, agent de localisation {unit_id}\u00a0: {fault}",
  "unregistered-unit": "Boîtier non enregistré émet\u00a0: {unit_id}",
  "duplicate-unit":
    "{who}\u00a0: identifiant en double, deux boîtiers émettent comme {unit_id}, l’un est masqué\u00a0; trouver l’autre et l’éteindre, ou révoquer {unit_id}",
  "duplicate-agent":
    "{who}\u00a0: agent de localisation en double, deux machines localisent pour {unit_id}, l’une est masquée\u00a0; trouver l’autre et l’éteindre, ou révoquer {unit_id}",
  "calibration-old": "{who}\u00a0: étalonnage du boîtier du {calibrated}\u00a0; à refaire au retour",
  "calibration-poor": "{who}\u00a0: étalonnage du boîtier insuffisant ({fault})\u00a0; à refaire au retour",
  "work-limit": "{who}\u00a0: durée d’engagement atteinte ({minutes}), envoyer au repos",
  "station-fault": "{fault}",
};

export const alarm_label: Part<"alarm_label"> = {
  mayday: "Mayday",
  fall: "Chute",
  "no-motion": "Immobile",
  "no-motion/pre-alert": "Immobile\u00a0: préalarme",
  "missed-check-in": "PAR en retard",
  heat: "Chaleur",
  "heat/caution": "Chaleur\u00a0: attention",
  "heat/warning": "Chaleur\u00a0: alerte",
  "heat/critical": "Chaleur\u00a0: critique",
  "heat-dose": "Limite de chaleur atteinte",
  battery: "Batterie faible",
  "link-lost": "Liaison perdue",
  "link-lost/switched off": "Éteint",
  "tracker-degraded": "Localisation incertaine",
  "tracker-degraded/lost": "Localisation perdue",
  "tracker-gone": "Agent de localisation absent",
  "worn-wrong": "Mal porté\u00a0: pas au pied",
  "position-lost": "Position perdue",
  "gps-unused": "GPS non utilisé",
  "unit-fault": "Défaut du boîtier",
  "tracker-fault": "Défaut de la localisation",
  "unknown-unit": "Boîtier non enregistré",
  "cloned-unit": "Identifiant en double",
  calibration: "Étalonnage",
  "calibration/old": "Étalonnage ancien",
  "calibration/poor": "Étalonnage insuffisant",
  "rest-due": "Durée d’engagement atteinte",
};

export const tracker_reason: Part<"tracker_reason"> = {
  aligning: "verticale pas encore connue\u00a0: rester immobile",
  "no-stance": "aucun pas détecté",
  "gyro-saturated": "rotation plus rapide que mesurable",
  "accel-saturated": "choc plus fort que mesurable",
  "sample-gap": "mesures manquantes",
  "bad-samples": "mesures inutilisables",
  uncertain: "position approximative",
  unsettled: "cap pas encore stable\u00a0: rester immobile cinq secondes",
  inconsistent: "pas en contradiction avec le mouvement\u00a0: hauteur inconnue",
  "not-on-foot": "pas porté au pied\u00a0: fixer sur le cou-de-pied",
  none: "sans raison indiquée",
};

export const fix_fault: Part<"fix_fault"> = {
  "not-a-number": "coordonnées non numériques",
  "not-on-earth": "coordonnées hors de la Terre",
  zero: "latitude et longitude nulles",
  height: "altitude impossible",
  accuracy: "précision inutilisable",
  "far-away": "trop loin du site",
  stuck: "récepteur bloqué",
};

export const alarm_subject: Part<"alarm_subject"> = {
  either: "{member} ou, avant, {before}",
};

export const alarm_now: Part<"alarm_now"> = {
  live: "En direct\u00a0: {text}",
  station_lost: "Liaison avec la station perdue",
};
