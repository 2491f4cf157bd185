/** Findings of a unit’s check at its start, by their codes. */

export const unit_check = {
  "check-battery": "{level_fraction} of {of}",
  "check-battery-left": "{level_fraction} of {of}, {left_h, number} h left",
  "check-battery-unknown": "the unit does not know its battery",
  "check-broken": "it has failed ({error})",
  "check-calibration-of": "{identity} of {day}",
  "check-certificate-ends": "valid to {day}",
  "check-disk-free": "{free_gb, number} GB free",
  "check-disk-short": "{free_gb, number} GB free of the {wanted_gb, number} GB that journal and black box may take",
  "check-disk-silent": "it does not answer",
  "check-finding": "{subject}: {text}",
  "check-foreign-journal": "it held another unit’s journal, which is now in {folder}",
  "check-gravity": "{force_mps2, number} m/s² at rest, gravity is {gravity_mps2, number}",
  "check-never-still": "it was never still for a second",
  "check-no-calibration": "none",
  "check-no-certificate": "none: the link is not secured",
  "check-no-fix": "no fix yet",
  "check-no-reading": "no reading",
  "check-no-receiver": "the unit has no receiver",
  "check-no-samples": "{source} gave no samples",
  "check-no-temperature": "the unit has no sensor",
  "check-none": "the unit has none",
  "check-range": "{accel_g, number} g and {gyro_degps, number} deg/s",
  "check-rate": "{rate_hz, number} samples/s of {stated_hz, number}, longest gap {gap_ms, number} ms",
  "check-receiver-silent": "the receiver is silent",
  "check-sensor": "the sensor",
  "check-subject":
    "{subject, select, inertial_sensor {inertial sensor} sample_rate {sample rate} measuring_range {measuring range} accelerometer {accelerometer} gyroscope {gyroscope} magnetic_field {magnetic field} air_pressure {air pressure} rest {rest} calibration {calibration} certificate {certificate} disk {disk} data_folder {data folder} temperature {temperature} battery {battery} satellites {satellites} mayday_button {mayday button} output {output} start_check {check at the start} other {{subject}}}",
  "check-subject-named":
    "{subject, select, inertial_sensor {inertial sensor} sample_rate {sample rate} measuring_range {measuring range} accelerometer {accelerometer} gyroscope {gyroscope} magnetic_field {magnetic field} air_pressure {air pressure} rest {rest} calibration {calibration} certificate {certificate} disk {disk} data_folder {data folder} temperature {temperature} battery {battery} satellites {satellites} mayday_button {mayday button} output {output} start_check {check at the start} other {{subject}}} {sensor}",
  "check-subject-of":
    "{subject, select, inertial_sensor {inertial sensor} sample_rate {sample rate} measuring_range {measuring range} accelerometer {accelerometer} gyroscope {gyroscope} magnetic_field {magnetic field} air_pressure {air pressure} rest {rest} calibration {calibration} certificate {certificate} disk {disk} data_folder {data folder} temperature {temperature} battery {battery} satellites {satellites} mayday_button {mayday button} output {output} start_check {check at the start} other {{subject}}} of {sensor}",
  "check-turn-at-rest": "{rate_degps, number} deg/s at rest",
} as const;
