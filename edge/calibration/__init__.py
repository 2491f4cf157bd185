"""A unit's own sensor errors: found by a person's help, kept in a file, taken out of samples."""

from __future__ import annotations

from edge.calibration.correction import Correction
from edge.calibration.file import identity, read_calibration, write_calibration
from edge.calibration.model import Calibration

__all__ = ["Calibration", "Correction", "identity", "read_calibration", "write_calibration"]
