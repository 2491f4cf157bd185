import type { Part } from "../catalogue";

export const alarm_text: Part<"alarm_text"> = {
  mayday: "Atemschutznotfall (Mayday): {who}",
  fall: "{who}: möglicher Sturz",
  "no-motion": "{who}: keine Bewegung seit {duration}",
  "par-overdue": "{who}: PAR überfällig, seit {minutes} nicht bestätigt",
  "par-overdue-unanswered": "{who}: PAR überfällig, seit {minutes} keine Antwort",
  "par-overdue-unconfirmed": "{who}: PAR überfällig, noch nicht bestätigt, im Einsatz seit {minutes}",
  "par-overdue-no-answer-yet": "{who}: PAR überfällig, keine Antwort, im Einsatz seit {minutes}",
  heat: "{who}: Ausrüstung bei {temperature}, Hitzegrenze zu {heat} ausgeschöpft",
  "heat-limit": "{who}: Hitzegrenze der Ausrüstung erreicht, sie kann ausfallen",
  "heat-limit-late":
    "{who}: Hitzegrenze der Ausrüstung laut Speicher schon früher erreicht, sie kann ausfallen",
  "battery-low": "{who}: Akku des Geräts bei {battery}",
  "signal-lost": "{who}: kein Signal seit {duration}",
  "unit-off": "{who}: Gerät wurde ausgeschaltet",
  "tracker-unsure": "{who}: Ortung des Geräts unsicher ({reasons})",
  "tracker-lost": "{who}: Ortung des Geräts verloren ({reasons})",
  "agent-silent":
    "{who}: nicht geortet, der Dienst für {unit_id} antwortet nicht; starten, die gezeigte Position ist alt",
  "agent-never-started":
    "{who}: nicht geortet, der Dienst für {unit_id} läuft nicht; starten, die gezeigte Position ist alt",
  "not-on-foot": "{who}: Gerät nicht am Fuß getragen, die Position ist falsch, bis es am Rist befestigt ist",
  "position-lost": "{who}: Position verloren (auf {radius} genau)",
  "position-lost-tracker": "{who}: Position verloren (Ortung des Geräts verloren: {reasons})",
  "gps-unused": "{who}: GPS wird nicht verwendet ({reasons})",
  "unit-fault": "{who}, Gerät: {fault}",
  "agent-fault": "{who}, Ortungsdienst {unit_id}: {fault}",
  "unregistered-unit": "Nicht angemeldetes Gerät sendet: {unit_id}",
  "duplicate-unit":
    "{who}: Gerätekennung doppelt, zwei Geräte melden sich als {unit_id}, eines ist verborgen; das andere suchen und ausschalten oder {unit_id} sperren",
  "duplicate-agent":
    "{who}: Ortungsdienst doppelt, zwei Rechner orten für {unit_id}, einer ist verborgen; den anderen suchen und ausschalten oder {unit_id} sperren",
  "calibration-old": "{who}: Kalibrierung des Geräts vom {calibrated}; nach der Rückkehr neu kalibrieren",
  "calibration-poor": "{who}: Kalibrierung des Geräts schlecht ({fault}); nach der Rückkehr neu kalibrieren",
  "work-limit": "{who}: Einsatzdauer erreicht ({minutes}), zur Erholung schicken",
  "station-fault": "{fault}",
};

export const alarm_label: Part<"alarm_label"> = {
  mayday: "Mayday",
  fall: "Sturz",
  "no-motion": "Keine Bewegung",
  "no-motion/pre-alert": "Keine Bewegung: Voralarm",
  "missed-check-in": "PAR überfällig",
  heat: "Hitze",
  "heat/caution": "Hitze: Achtung",
  "heat/warning": "Hitze: Warnung",
  "heat/critical": "Hitze: kritisch",
  "heat-dose": "Hitzegrenze erreicht",
  battery: "Akku schwach",
  "link-lost": "Verbindung verloren",
  "link-lost/switched off": "Ausgeschaltet",
  "tracker-degraded": "Ortung unsicher",
  "tracker-degraded/lost": "Ortung verloren",
  "tracker-gone": "Ortungsdienst fehlt",
  "worn-wrong": "Falsch getragen: nicht am Fuß",
  "position-lost": "Position verloren",
  "gps-unused": "GPS nicht verwendet",
  "unit-fault": "Gerätestörung",
  "tracker-fault": "Störung der Ortung",
  "unknown-unit": "Gerät nicht angemeldet",
  "cloned-unit": "Gerätekennung doppelt",
  calibration: "Kalibrierung",
  "calibration/old": "Kalibrierung alt",
  "calibration/poor": "Kalibrierung schlecht",
  "rest-due": "Einsatzdauer erreicht",
};

export const tracker_reason: Part<"tracker_reason"> = {
  aligning: "Lotrichtung noch unbekannt: stillstehen",
  "no-stance": "kein Tritt erkannt",
  "gyro-saturated": "schneller gedreht als messbar",
  "accel-saturated": "Stoß stärker als messbar",
  "sample-gap": "Messwerte fehlen",
  "bad-samples": "Messwerte unbrauchbar",
  uncertain: "Position nur ungefähr bekannt",
  unsettled: "Richtung noch unsicher: fünf Sekunden stillstehen",
  inconsistent: "Tritte widersprechen der Bewegung dazwischen: Höhe unbekannt",
  "not-on-foot": "nicht am Fuß getragen: am Rist befestigen",
  none: "ohne Angabe von Gründen",
};

export const fix_fault: Part<"fix_fault"> = {
  "not-a-number": "Koordinaten sind keine Zahlen",
  "not-on-earth": "Koordinaten nicht auf der Erde",
  zero: "Breite und Länge 0",
  height: "unmögliche Höhe",
  accuracy: "Genauigkeit unbrauchbar",
  "far-away": "zu weit von der Einsatzstelle",
  stuck: "Empfänger hängt",
};

export const alarm_subject: Part<"alarm_subject"> = {
  either: "{member} oder vorher {before}",
};

export const alarm_now: Part<"alarm_now"> = {
  live: "Jetzt live: {text}",
  station_lost: "Verbindung zur Basisstation verloren",
};
