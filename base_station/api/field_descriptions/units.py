"""Descriptions of fields about wearable units: enrolment, sensors and posted samples."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- units
    "unit_id": "The wearable unit's id, as it is enrolled.",
    "unit_ids": "Ids of the wearable units.",
    "UnitAnswer.person_id": "Id of the person who wears it; null: none does.",
    "registered": "Whether messages of the unit count; else it is only listed.",
    "UnitToken.expires_ms": "When the token ends; null: it does not.",
    "UnitToken.username": "Who made it; it ends when this user is removed.",
    "last_heard_ms": "When a message of the unit last came; null: none has.",
    "software_version": "The version of Muster on the unit.",
    "source": "Which sensor source the unit reads.",
    "sensor_name": "What the sensor calls itself.",
    "tracker": "Name of the tracker that the unit runs.",
    "calibration": "Which calibration the unit uses; empty: none.",
    "sensors": "Inertial sensors of the unit; empty: not known yet.",
    "WornSensorView.name": "Name of the sensor in the unit; empty: it is the only one.",
    "place": "Part of the body where the sensor is worn, such as left_foot; empty: unknown.",
    "place_recognised": "Whether the unit recognised that place by the motion.",
    "mount": "How the sensor is fastened, in words.",
    "model": "What the sensor calls itself.",
    "has_gps": "Whether the unit has a satellite receiver.",
    # ---- posted samples
    "accepted": "Batches of this post that were new, and are recorded.",
    "SamplesReceipt.repeated": "Batches of this post that had been recorded before.",
    "samples": "Samples in the batches that were new.",
    "boot_id": "A random number that the node draws at each start of its program; its batches are "
    "numbered and its samples timed anew with it.",
    "batches": "One batch or more of this run, in the order of seq.",
    "SampleBatch.seq": "Number of the batch in this run, from 1; the same number is the same "
    "batch, however often it is sent.",
    "t_ns": "Time of each sample in nanoseconds, of a clock of the node that never goes back.",
    "accel_mps2": "Specific force of each sample in m/s^2, sensor axes x, y, z, gravity included; "
    "null: missed.",
    "gyro_radps": "Angular rate of each sample in rad/s, sensor axes x, y, z; null: missed.",
    "mag_ut": "Magnetic flux density of each sample in microtesla, sensor axes x, y, z; null: the "
    "node has no magnetometer.",
    "pressure_pa": "Air pressure of each sample in Pa; null: the node has no barometer.",
    "imu_temperature_degc": "Temperature inside the sensor at each sample in degrees Celsius; "
    "null: it is not measured.",
    # ---- enrolments
    "NewEnrolment.days": "For how many days the certificate is valid.",
    "renew": "Whether the unit is enrolled already and gets a new certificate; the old one works "
    "until it ends.",
    "valid_to_ms": "When the certificate ends.",
    "ShownEnrolment.text": "The enrolment as the QR code has it; saved as a file it is one. It "
    "holds the private key, and is shown this once.",
    "qr_rows": "The QR code without its margin, a text for each row: 1 is a dark module, 0 a light "
    "one.",
}
