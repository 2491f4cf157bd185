/** Findings of a unit’s check at its start, by their codes, in German. */
import type { Part } from "../catalogue";

export const unit_check: Part<"unit_check"> = {
  "check-battery": "{level_fraction} von {of}",
  "check-battery-left": "{level_fraction} von {of}, noch {left_h, number} h",
  "check-battery-unknown": "das Gerät kennt seinen Akku nicht",
  "check-broken": "sie ist fehlgeschlagen ({error})",
  "check-calibration-of": "{identity} vom {day}",
  "check-certificate-ends": "gültig bis {day}",
  "check-disk-free": "{free_gb, number} GB frei",
  "check-disk-short": "{free_gb, number} GB frei von {wanted_gb, number} GB, die Journal und Blackbox brauchen dürfen",
  "check-disk-silent": "er antwortet nicht",
  "check-finding": "{subject}: {text}",
  "check-foreign-journal": "er enthielt das Journal eines anderen Geräts, das jetzt in {folder} liegt",
  "check-gravity": "{force_mps2, number} m/s² in Ruhe, die Erdbeschleunigung ist {gravity_mps2, number}",
  "check-never-still": "er lag nie eine Sekunde still",
  "check-no-calibration": "keine",
  "check-no-certificate": "keines: Die Verbindung ist nicht gesichert",
  "check-no-fix": "noch keine Position",
  "check-no-reading": "kein Messwert",
  "check-no-receiver": "das Gerät hat keinen Empfänger",
  "check-no-samples": "{source} hat keine Messwerte geliefert",
  "check-no-temperature": "das Gerät hat keinen Sensor",
  "check-none": "das Gerät hat keine",
  "check-range": "{accel_g, number} g und {gyro_degps, number} °/s",
  "check-rate": "{rate_hz, number} Messwerte/s von {stated_hz, number}, längste Lücke {gap_ms, number} ms",
  "check-receiver-silent": "der Empfänger schweigt",
  "check-sensor": "der Sensor",
  "check-subject":
    "{subject, select, inertial_sensor {Inertialsensor} sample_rate {Abtastrate} measuring_range {Messbereich} accelerometer {Beschleunigungssensor} gyroscope {Drehratensensor} magnetic_field {Magnetfeld} air_pressure {Luftdruck} rest {Ruhe} calibration {Kalibrierung} certificate {Zertifikat} disk {Datenträger} data_folder {Datenordner} temperature {Temperatur} battery {Akku} satellites {Satelliten} mayday_button {Notruftaste} output {Ausgabe} start_check {Prüfung beim Start} other {{subject}}}",
  "check-subject-named":
    "{subject, select, inertial_sensor {Inertialsensor} sample_rate {Abtastrate} measuring_range {Messbereich} accelerometer {Beschleunigungssensor} gyroscope {Drehratensensor} magnetic_field {Magnetfeld} air_pressure {Luftdruck} rest {Ruhe} calibration {Kalibrierung} certificate {Zertifikat} disk {Datenträger} data_folder {Datenordner} temperature {Temperatur} battery {Akku} satellites {Satelliten} mayday_button {Notruftaste} output {Ausgabe} start_check {Prüfung beim Start} other {{subject}}} {sensor}",
  "check-subject-of":
    "{subject, select, inertial_sensor {Inertialsensor} sample_rate {Abtastrate} measuring_range {Messbereich} accelerometer {Beschleunigungssensor} gyroscope {Drehratensensor} magnetic_field {Magnetfeld} air_pressure {Luftdruck} rest {Ruhe} calibration {Kalibrierung} certificate {Zertifikat} disk {Datenträger} data_folder {Datenordner} temperature {Temperatur} battery {Akku} satellites {Satelliten} mayday_button {Notruftaste} output {Ausgabe} start_check {Prüfung beim Start} other {{subject}}} von {sensor}",
  "check-turn-at-rest": "{rate_degps, number} °/s in Ruhe",
};
