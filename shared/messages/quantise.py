"""Numbers to and from the integers on the wire; out of range saturates, never wraps."""

from __future__ import annotations

import math

_TWO_PI = 2.0 * math.pi
HALF_TURN_CDEG = 18_000
_CDEG_PER_RAD = HALF_TURN_CDEG / math.pi
_SIGNED_MOST = float(2**31 - 1)
_UNSIGNED_MOST = float(2**32 - 1)


def signed32(value: float, scale: float) -> int:
    """``value * scale`` rounded into a sint32; NaN is a caller's mistake and raises ValueError."""
    scaled = value * scale
    if -_SIGNED_MOST <= scaled <= _SIGNED_MOST:
        return round(scaled)
    return _saturated(scaled, -_SIGNED_MOST, _SIGNED_MOST)


def unsigned32(value: float, scale: float) -> int:
    """``value * scale`` rounded into a uint32; negative becomes 0."""
    scaled = value * scale
    if 0.0 <= scaled <= _UNSIGNED_MOST:
        return round(scaled)
    return _saturated(scaled, 0.0, _UNSIGNED_MOST)


def _saturated(scaled: float, least: float, most: float) -> int:
    if math.isnan(scaled):
        raise ValueError("not a number")
    return round(least if scaled < least else most)


def unsigned_known(value: float, scale: float) -> int:
    """As ``unsigned32``, where 0 says that nothing is known: what is known is at least 1."""
    return max(unsigned32(value, scale), 1) if value > 0.0 else 0


def heading_to_cdeg(heading_rad: float) -> int:
    """Any heading into 0..35999 hundredths of a degree."""
    return round(math.fmod(heading_rad, _TWO_PI) * _CDEG_PER_RAD) % 36_000


def cdeg_to_heading(cdeg: int) -> float:
    return cdeg / _CDEG_PER_RAD


def angle_std_to_cdeg(std_rad: float) -> int:
    """An angle's standard deviation; past half a turn nothing is known: 18000."""
    return min(HALF_TURN_CDEG, unsigned32(std_rad, _CDEG_PER_RAD))


def angle_std_known_to_cdeg(std_rad: float) -> int:
    """The same where 0 says that there is no such angle: what is known is at least 1."""
    return max(angle_std_to_cdeg(std_rad), 1)
