"""Correction of a unit's sensor errors in its samples as they come."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from edge.calibration.model import Calibration
from edge.samples import Floats, ImuBatch, SensorDescription


class Correction:
    """Correction of the samples of one unit in order; the same however they are batched.

    Most sensors report their temperature less often than motion: the last value holds until the
    next.
    """

    def __init__(self, calibration: Calibration, sensor: SensorDescription) -> None:
        self._calibration = calibration
        self._sensor = sensor
        self._last_degc = math.nan

    def push(self, imu: ImuBatch) -> ImuBatch:
        degc = imu.imu_temperature_degc
        if degc is None or not len(imu):
            return self._calibration.apply(imu, self._sensor)
        filled = replace(imu, imu_temperature_degc=self._hold_last(degc))
        return replace(self._calibration.apply(filled, self._sensor), imu_temperature_degc=degc)

    def _hold_last(self, degc: Floats) -> Floats:
        rows = np.where(np.isfinite(degc), np.arange(len(degc)), -1)
        last_known = np.maximum.accumulate(rows)
        filled = np.where(last_known < 0, self._last_degc, degc[last_known])
        self._last_degc = float(filled[-1])
        return filled
