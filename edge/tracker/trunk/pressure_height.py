"""Height by air pressure (Li et al. 2014, section 3.5): P = P0 (1 - H / 44330)^5.255.

Only differences count, from the pressure of the start, so P0 may be the standard one.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.trunk.state import Row, TrunkConfig, TrunkState

_STANDARD_PA = 101_325.0
_SCALE_M, _EXPONENT = 44_330.0, 5.255
_THINNEST_PA, _DENSEST_PA = 3e4, 1.2e5  # readings beyond these are no pressure on foot


@njit()
def pressure_height_m(pressure_pa: float) -> float:
    """Return the height in the standard atmosphere."""
    return float(_SCALE_M * (1.0 - (pressure_pa / _STANDARD_PA) ** (1.0 / _EXPONENT)))


@njit()
def follow_height(here: Row, trunk: TrunkState, config: TrunkConfig) -> None:
    """Take the pressure of a sample, if there is one, into the smoothed height."""
    pressure_pa = here.pressure_pa
    if not _THINNEST_PA < pressure_pa < _DENSEST_PA:
        return  # also when it is not a number
    height_m = pressure_height_m(pressure_pa)
    if not trunk.has_pressure:
        trunk.has_pressure = True
        trunk.reference_m = height_m
        trunk.began_s = trunk.pressure_s = here.t_s
    since_s = here.t_s - trunk.pressure_s
    trunk.pressure_s = here.t_s
    if here.t_s - trunk.began_s < config.pressure_smooth_s:  # the start: still its mean
        share = since_s / max(here.t_s - trunk.began_s, since_s) if since_s > 0.0 else 0.0
        trunk.reference_m += share * (height_m - trunk.reference_m)
        return
    share = since_s / (config.pressure_smooth_s + since_s)
    trunk.height_m += share * (height_m - trunk.reference_m - trunk.height_m)


@njit()
def height_var_m2(trunk: TrunkState, t_s: float, config: TrunkConfig) -> float:
    """Return the stated variance of the height; without a barometer a way is taken for level."""
    if not trunk.has_pressure:
        return float((config.level_error_per_distance * trunk.distance_m) ** 2)
    drift_m2 = config.height_walk_mpsqs**2 * (t_s - trunk.began_s)
    return float(config.height_std_m**2 + drift_m2)
