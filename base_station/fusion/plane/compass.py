"""What a unit's compass is worth to its heading.

What bends a field lasts: a thousand words of a compass are hardly worth more than one.  So a
heading is brought to what the compass states of itself and never beyond, whatever is heard how
often; and where the path and satellite fixes have made it known better, nothing is heard at all.
"""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.port import Bearing
from shared.clock import NS_PER_S
from shared.earth_field import earth_field
from shared.geo import Anchor, wrap_pi
from shared.messages import MagneticNorth

_DAY_NS = 86_400 * NS_PER_S
_PLACE_DIGITS = 2  # of degrees
_PLAN_STD_RAD = 0.02  # how well plans are laid on the map
_GATE = 3.0  # standard deviations
_ONE_FIX = 5.0  # tells no more, for it may be wrong itself
_REFUTED = 8.0
_WORTH = 0.9  # of the variance held: a compass that leaves more is not listened to


CONTRADICTS2 = 13.8  # chi-square of 2 degrees of freedom, 99.9 %


class CompassUse(msgspec.Struct):
    """What became of one unit's compass: a compass is heard beside a filter that does not hear it,
    and fixes decide between the two.
    """

    said: Bearing | None = None  # last
    refuted: bool = False  # it is not heard again
    against: float = 0.0  # how much likelier fixes were without it, as a logarithm

    def weigh(self, with_distance2: float, without_distance2: float) -> None:
        """A fix lies so far from what is believed with and without the compass, chi-square."""
        told = 0.5 * (with_distance2 - without_distance2)
        self.against += min(max(told, -_ONE_FIX), _ONE_FIX)
        self.refuted |= self.against > _REFUTED

    def compare(self, without: tuple[float, float]) -> bool:
        """Whether the compass is of no more use: fixes refute it, or know the heading better.
        ``without`` it, it is this turn and standard deviation.
        """
        assert self.said is not None
        turn_rad, std_rad = without
        off_rad = abs(wrap_pi(self.said.turn_rad - turn_rad))
        self.refuted |= off_rad > _GATE * math.hypot(std_rad, self.said.std_rad)
        return self.refuted or std_rad < self.said.std_rad


def bearing_of(north: MagneticNorth, anchor: Anchor, utc_ns: int) -> Bearing | None:
    """How a unit's own frame is turned in the incident frame; None where the declination is not
    known, because there is no magnetic model of that date.
    """
    lat_deg, lon_deg = round(anchor.lat_deg, _PLACE_DIGITS), round(anchor.lon_deg, _PLACE_DIGITS)
    field = earth_field(lat_deg, lon_deg, 0.0, utc_ns - utc_ns % _DAY_NS)
    if isinstance(field, str):
        return None
    turn_rad = field.declination_rad - north.heading_rad - anchor.rotation_rad
    std_rad = math.hypot(north.std_rad, field.declination_std_rad, _PLAN_STD_RAD)
    return Bearing(wrap_pi(turn_rad), std_rad)


def worth_of(held_std_rad: float, bearing: Bearing) -> float:
    """Variance of a measurement that brings a heading held like that to just what the compass
    states; infinite where that is not worth it.
    """
    held_var, own_var = held_std_rad**2, bearing.std_rad**2
    if not own_var < _WORTH * held_var:
        return math.inf
    return own_var * held_var / (held_var - own_var)


def turn_by(held: tuple[float, float], bearing: Bearing) -> tuple[float, float] | None:
    """Turn and variance after the compass was heard; ``held`` is turn and standard deviation.  None
    where it tells nothing, or contradicts what is known.
    """
    held_rad, held_std_rad = held
    off_rad = wrap_pi(bearing.turn_rad - held_rad)
    contradicts = abs(off_rad) > _GATE * math.hypot(held_std_rad, bearing.std_rad)
    if contradicts or worth_of(held_std_rad, bearing) == math.inf:
        return None
    gain = 1.0 - bearing.std_rad**2 / held_std_rad**2
    return held_rad + gain * off_rad, bearing.std_rad**2
