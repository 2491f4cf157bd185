"""Accuracy of a fix: standard deviations from what receivers report.

``horizontal_std_m`` is that of each axis, so a radial error is divided by the square root of two.
"""

from __future__ import annotations

import math

NAN = math.nan
# User equivalent range error (1 sigma) near the ground with a small antenna: what is left of
# orbits, clocks, air and reflections for one satellite.  A dilution of precision multiplies it.
UERE_SINGLE_M = 5.0
UERE_CORRECTED_M = 2.5  # with corrections for the region (SBAS, DGPS)
UERE_CARRIER_M = 1.0  # with the carrier's phase (RTK), if what is worn keeps it

_DOP_MOST = 50.0  # receivers say 99.99 for "none"


def from_axes(north_std_m: float, east_std_m: float) -> float:
    """Return one standard deviation of each axis for two that differ; NaN where either is not
    known.
    """
    if not (north_std_m > 0.0 and east_std_m > 0.0):
        return NAN
    return math.hypot(north_std_m, east_std_m) / math.sqrt(2.0)


def from_hdop(hdop: float, uere_m: float) -> float:
    """Return that of each axis, by the horizontal dilution of precision, which is that of both
    together.
    """
    return from_dop(hdop, uere_m) / math.sqrt(2.0)


def from_dop(dop: float, uere_m: float) -> float:
    return dop * uere_m if 0.0 < dop < _DOP_MOST else NAN


def first_known(*stds_m: float) -> float:
    """Return the first that is known; NaN where none is."""
    return next((std_m for std_m in stds_m if std_m > 0.0 and math.isfinite(std_m)), NAN)
