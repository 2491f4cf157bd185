"""A time over which the temperature at a unit is known."""

from __future__ import annotations

import msgspec


class ExposureInterval(msgspec.Struct):
    """Part of one run of the unit's program, without a silence; the unit's monotonic time."""

    boot_id: int
    first_ns: int
    first_degc: float
    last_ns: int
    last_degc: float
