"""Calibration that a unit was given: checked for its unit, sensor and age."""

from __future__ import annotations

import logging
from datetime import UTC, datetime
from pathlib import Path

from edge.calibration.file import identity, read_calibration, write_calibration
from edge.calibration.model import Calibration
from edge.samples import SensorDescription
from shared.errors import ConfigError, UserError

_log = logging.getLogger(__name__)


def calibration_in_use(
    path: Path | None, unit_id: str, sensor: SensorDescription, used: Path
) -> Calibration | None:
    """Return the calibration in a file, if it is of this unit and this sensor; a copy is kept with
    those that were ``used``.
    """
    if path is None:
        return None
    calibration = read_calibration(path)
    for what, made_for, this in (
        ("unit", calibration.unit, unit_id),
        ("sensor", calibration.sensor, sensor.name),
    ):
        if made_for and made_for != this:
            raise ConfigError(
                f"{path} is for {what} {made_for!r}, and this is {this!r}; give "
                "its own calibration, or none"
            )
    if calibration.is_old(datetime.now(UTC)):
        _log.warning("the calibration is old (%s); make a new one", calibration.made.date())
    for fault in calibration.faults():
        _log.warning("the calibration is poor: %s; make a new one", fault)
    _keep(calibration, used)
    return calibration


def _keep(calibration: Calibration, used: Path) -> None:
    copy = used / f"{identity(calibration)}.toml"
    if copy.exists():
        return
    try:
        used.mkdir(exist_ok=True)
        write_calibration(calibration, copy)
    except (OSError, UserError) as error:  # a full disk stops no unit
        _log.warning("no copy of the calibration is kept: %s", error)
