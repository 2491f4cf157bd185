"""Distance of a radio beacon from its received signal strength.

Log-distance path loss, ``rssi = power - 10 n log10(range)`` (Rappaport, Wireless Communications,
2nd ed., 4.9.1), with the exponent and the shadowing measured inside buildings.
"""

from __future__ import annotations

import math

POWER_DBM = -59.0  # of a beacon at 1 m, where it does not say
EXPONENT = 2.2
SHADOWING_DB = 6.0  # bodies, doors, multipath
NEAREST_M, FURTHEST_M = 0.3, 50.0
LEAST_RSSI_DBM, MOST_RSSI_DBM = -120.0, 20.0  # what receivers say


def range_of(rssi_dbm: float, power_dbm: float = POWER_DBM) -> tuple[float, float]:
    """Return the distance in metres, and its standard deviation; the shadowing is a factor, not
    a length.
    """
    range_m = 10.0 ** ((power_dbm - rssi_dbm) / (10.0 * EXPONENT))
    range_m = min(max(range_m, NEAREST_M), FURTHEST_M)
    factor = math.log(10.0) * SHADOWING_DB / (10.0 * EXPONENT)
    return range_m, range_m * factor
