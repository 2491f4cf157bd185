"""Inertial sensor of a unit in its pipeline: data sheet, calibration and name."""

from __future__ import annotations

from dataclasses import dataclass, replace

import msgspec

from edge.calibration.correction import Correction
from edge.calibration.file import identity
from edge.calibration.model import Calibration
from edge.sample_codec.descriptions import unit_sensor
from edge.samples import SensorDescription
from shared.messages import UnitSensor


@dataclass(frozen=True, slots=True)
class FittedSensor:
    """Sensor of a unit."""

    description: SensorDescription  # before its samples are corrected
    calibration: Calibration | None = None
    name: str = ""  # in the unit; empty: its only one

    @property
    def corrected(self) -> SensorDescription:
        """Data sheet of its samples once they are corrected."""
        if self.calibration is None:
            return self.description
        return self.calibration.described(self.description)

    def correction(self) -> Correction | None:
        """Return a new correction of its samples; None where it has no calibration."""
        if self.calibration is None:
            return None
        return Correction(self.calibration, self.corrected)

    def as_sent(self, recognised_place: str = "") -> UnitSensor:
        """Return the part of the unit's description that describes it.

        ``recognised_place``: place on the body by its motion, where none is configured.
        """
        description = self.description
        is_recognised = bool(recognised_place) and not description.place
        if is_recognised:
            description = replace(description, place=recognised_place)
        sent = unit_sensor(self.name, description)
        calibration = self.calibration
        if calibration is not None:
            sent = msgspec.structs.replace(
                sent,
                calibration=identity(calibration),
                calibrated_s=round(calibration.made.timestamp()),
                calibration_faults="; ".join(calibration.faults()),
            )
        return msgspec.structs.replace(sent, place_recognised=is_recognised)
