"""Conversion of times between the clocks of path, fixes and station."""

from __future__ import annotations

import msgspec

from base_station.core.state import StationState, UnitState
from base_station.core.state.boot_state import BootState
from shared.messages import GpsFix


def station_ns(state: StationState, unit: UnitState, t_mono_ns: int) -> int:
    """Return the station time of a time of the unit's path; the present time where it is not known
    yet.
    """
    return placed_ns(unit.path_boot, t_mono_ns, state.t_ns)


def placed_ns(boot: BootState, t_mono_ns: int, now_ns: int) -> int:
    """Return the station time of a time of a boot, at most the present; the present where it is not
    known yet.
    """
    return min(boot.station_ns(t_mono_ns), now_ns) if boot.is_placed else now_ns


def in_clock_of_path(unit: UnitState, fix: GpsFix) -> GpsFix:
    """Convert a time of a fix to the clock of the path: a remotely tracked unit has its fixes in
    its own clock, its path in the agent's.
    """
    ahead_ns = unit.boots[-1].offset_ns - unit.path_boot.offset_ns
    if ahead_ns == 0:
        return fix
    t_mono_ns = fix.header.t_mono_ns + ahead_ns
    header = msgspec.structs.replace(fix.header, t_mono_ns=t_mono_ns)
    return msgspec.structs.replace(fix, header=header)
