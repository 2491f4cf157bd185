"""Numbers to and from the integers on the wire; out of range saturates, never wraps."""

from __future__ import annotations

import math

_TWO_PI = 2.0 * math.pi
HALF_TURN_CDEG = 18_000
_CDEG_PER_RAD = HALF_TURN_CDEG / math.pi
_SIGNED_MOST = 2**31 - 1
_UNSIGNED_MOST = 2**32 - 1


def signed32(value: float, scale: float) -> int:
    """``value * scale`` rounded into a sint32; NaN is a caller's mistake and raises ValueError."""
    try:
        number = round(value * scale)
    except OverflowError:  # infinite
        return _SIGNED_MOST if value > 0.0 else -_SIGNED_MOST
    if -_SIGNED_MOST <= number <= _SIGNED_MOST:
        return number
    return _SIGNED_MOST if number > 0 else -_SIGNED_MOST


def unsigned32(value: float, scale: float) -> int:
    """``value * scale`` rounded into a uint32; negative becomes 0."""
    try:
        number = round(value * scale)
    except OverflowError:  # infinite
        return _UNSIGNED_MOST if value > 0.0 else 0
    if 0 <= number <= _UNSIGNED_MOST:
        return number
    return _UNSIGNED_MOST if number > 0 else 0


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
