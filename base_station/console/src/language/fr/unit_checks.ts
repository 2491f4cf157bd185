/** Findings of a unit’s check at its start, by their codes, in French. */
import type { Part } from "../catalogue";

export const unit_check: Part<"unit_check"> = {
  "check-battery": "{level_fraction} de {of}",
  "check-battery-left": "{level_fraction} de {of}, encore {left_h, number} h",
  "check-battery-unknown": "l’appareil ne connaît pas sa batterie",
  "check-broken": "il a échoué ({error})",
  "check-calibration-of": "{identity} du {day}",
  "check-certificate-ends": "valable jusqu’au {day}",
  "check-disk-free": "{free_gb, number} Go libres",
  "check-disk-short":
    "{free_gb, number} Go libres sur les {wanted_gb, number} Go que le journal et la boîte noire peuvent prendre",
  "check-disk-silent": "il ne répond pas",
  "check-finding": "{subject}\u00a0: {text}",
  "check-foreign-journal": "il contenait le journal d’un autre appareil, qui est maintenant dans {folder}",
  "check-gravity": "{force_mps2, number} m/s² au repos, la pesanteur est de {gravity_mps2, number}",
  "check-never-still": "il n’est jamais resté immobile une seconde",
  "check-no-calibration": "aucun",
  "check-no-certificate": "aucun\u00a0: la liaison n’est pas sécurisée",
  "check-no-fix": "pas encore de position",
  "check-no-reading": "aucune mesure",
  "check-no-receiver": "l’appareil n’a pas de récepteur",
  "check-no-samples": "{source} n’a donné aucune mesure",
  "check-no-temperature": "l’appareil n’a pas de capteur",
  "check-none": "l’appareil n’en a pas",
  "check-range": "{accel_g, number} g et {gyro_degps, number} °/s",
  "check-rate": "{rate_hz, number} mesures/s sur {stated_hz, number}, plus longue lacune {gap_ms, number} ms",
  "check-receiver-silent": "le récepteur est muet",
  "check-sensor": "le capteur",
  "check-subject":
    "{subject, select, inertial_sensor {capteur inertiel} sample_rate {cadence} measuring_range {plage de mesure} accelerometer {accéléromètre} gyroscope {gyroscope} magnetic_field {champ magnétique} air_pressure {pression de l’air} rest {repos} calibration {étalonnage} certificate {certificat} disk {disque} data_folder {dossier de données} temperature {température} battery {batterie} satellites {satellites} mayday_button {bouton Mayday} output {sortie} start_check {contrôle au démarrage} other {{subject}}}",
  "check-subject-named":
    "{subject, select, inertial_sensor {capteur inertiel} sample_rate {cadence} measuring_range {plage de mesure} accelerometer {accéléromètre} gyroscope {gyroscope} magnetic_field {champ magnétique} air_pressure {pression de l’air} rest {repos} calibration {étalonnage} certificate {certificat} disk {disque} data_folder {dossier de données} temperature {température} battery {batterie} satellites {satellites} mayday_button {bouton Mayday} output {sortie} start_check {contrôle au démarrage} other {{subject}}} {sensor}",
  "check-subject-of":
    "{subject, select, inertial_sensor {capteur inertiel} sample_rate {cadence} measuring_range {plage de mesure} accelerometer {accéléromètre} gyroscope {gyroscope} magnetic_field {champ magnétique} air_pressure {pression de l’air} rest {repos} calibration {étalonnage} certificate {certificat} disk {disque} data_folder {dossier de données} temperature {température} battery {batterie} satellites {satellites} mayday_button {bouton Mayday} output {sortie} start_check {contrôle au démarrage} other {{subject}}} de {sensor}",
  "check-turn-at-rest": "{rate_degps, number} °/s au repos",
};
