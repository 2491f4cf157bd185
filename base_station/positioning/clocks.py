"""Whose clock a time of a path or a fix is in."""

from __future__ import annotations

import msgspec

from base_station.live_state import StationState, UnitState
from shared.messages import GpsFix


def station_ns(state: StationState, unit: UnitState, t_mono_ns: int) -> int:
    """The station's time of a time of the unit's path; not known yet: now."""
    boot = unit.path_boot
    return min(boot.station_ns(t_mono_ns), state.t_ns) if boot.is_placed else state.t_ns


def in_clock_of_path(unit: UnitState, fix: GpsFix) -> GpsFix:
    """A unit that is tracked remotely has its fixes in its own clock, its path in another."""
    ahead_ns = unit.boots[-1].offset_ns - unit.path_boot.offset_ns
    if ahead_ns == 0:
        return fix
    t_mono_ns = fix.header.t_mono_ns + ahead_ns
    header = msgspec.structs.replace(fix.header, t_mono_ns=t_mono_ns)
    return msgspec.structs.replace(fix, header=header)
