"""How far an estimate can be trusted, in the words that unit, wire and console share."""

from __future__ import annotations

from enum import IntEnum, IntFlag


class Quality(IntEnum):
    """The numbers are those on the wire."""

    UNKNOWN = 0
    GOOD = 1
    DEGRADED = 2
    LOST = 3


class Reason(IntFlag):
    """Why an estimate is not ``GOOD``; the bits are those on the wire."""

    NONE = 0
    ALIGNING = 1  # not enough stillness yet to know which way is down
    NO_STANCE = 2  # too long without a still instant
    GYRO_SATURATED = 4
    ACCEL_SATURATED = 8
    SAMPLE_GAP = 16
    BAD_SAMPLES = 32  # not finite, stuck or out of order: left out
    MAG_DISTURBED = 64
    UNCERTAIN = 128  # stated standard deviation past what a commander can use
