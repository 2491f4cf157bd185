"""Compass of a unit as a measurement of its heading.

Errors of a magnetic field last, so repeated readings add no information: a heading is brought to
the stated deviation of the compass and never below, and where path and fixes know it better the
compass is not used.
"""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.interface import CompassHeading
from shared.clock import NS_PER_S
from shared.earth_field import earth_field
from shared.geo import Anchor, wrap_pi
from shared.messages import MagneticNorth

_DAY_NS = 86_400 * NS_PER_S
_PLACE_DIGITS = 2  # of degrees
_PLAN_STD_RAD = 0.02  # how well plans are laid on the map
_GATE = 3.0  # standard deviations
_ONE_FIX = 5.0  # counts at most so much, for it may be wrong itself
_REFUTED = 8.0
_WORTH = 0.9  # of the variance held: a compass that leaves more is not used


CONTRADICTS2 = 13.8  # chi-square of 2 degrees of freedom, 99.9 %


class CompassTest(msgspec.Struct):
    """Likelihood ratio test of a compass: a filter with it against one without, by fixes."""

    last_heading: CompassHeading | None = None  # last
    is_rejected: bool = False  # it is not used again
    log_ratio: float = 0.0  # how much likelier fixes were without it, as a logarithm

    def add_fix(self, with_distance2: float, without_distance2: float) -> None:
        """Add a fix by its squared distances (chi-square) to the estimates with and without the
        compass.
        """
        evidence = 0.5 * (with_distance2 - without_distance2)
        self.log_ratio += min(max(evidence, -_ONE_FIX), _ONE_FIX)
        self.is_rejected |= self.log_ratio > _REFUTED

    def is_useless(self, without: tuple[float, float]) -> bool:
        """True where fixes reject the compass or know the heading better; ``without``: turn and
        standard deviation of the filter without it.
        """
        assert self.last_heading is not None
        turn_rad, std_rad = without
        off_rad = abs(wrap_pi(self.last_heading.turn_rad - turn_rad))
        self.is_rejected |= off_rad > _GATE * math.hypot(std_rad, self.last_heading.std_rad)
        return self.is_rejected or std_rad < self.last_heading.std_rad


def compass_heading(north: MagneticNorth, anchor: Anchor, utc_ns: int) -> CompassHeading | None:
    """Heading of a unit's own frame in the incident frame; None where no magnetic model of that
    date gives the declination.
    """
    lat_deg, lon_deg = round(anchor.lat_deg, _PLACE_DIGITS), round(anchor.lon_deg, _PLACE_DIGITS)
    field = earth_field(lat_deg, lon_deg, 0.0, utc_ns - utc_ns % _DAY_NS)
    if isinstance(field, str):
        return None
    turn_rad = field.declination_rad - north.heading_rad - anchor.rotation_rad
    std_rad = math.hypot(north.std_rad, field.declination_std_rad, _PLAN_STD_RAD)
    return CompassHeading(wrap_pi(turn_rad), std_rad)


def equivalent_variance(held_std_rad: float, heading: CompassHeading) -> float:
    """Variance of a measurement that brings a heading of this deviation exactly to the stated one
    of the compass; infinite where the gain is too small.

        R = s_c^2 s_h^2 / (s_h^2 - s_c^2)
    """
    held_var, own_var = held_std_rad**2, heading.std_rad**2
    if not own_var < _WORTH * held_var:
        return math.inf
    return own_var * held_var / (held_var - own_var)


def fused_turn(held: tuple[float, float], heading: CompassHeading) -> tuple[float, float] | None:
    """Turn and variance after the compass; ``held``: turn and standard deviation before. None where
    it adds nothing or contradicts.
    """
    held_rad, held_std_rad = held
    off_rad = wrap_pi(heading.turn_rad - held_rad)
    contradicts = abs(off_rad) > _GATE * math.hypot(held_std_rad, heading.std_rad)
    if contradicts or equivalent_variance(held_std_rad, heading) == math.inf:
        return None
    gain = 1.0 - heading.std_rad**2 / held_std_rad**2
    return held_rad + gain * off_rad, heading.std_rad**2
