"""Conversion of times between the clocks of path, fixes and station."""

from __future__ import annotations

import msgspec

from base_station.core.state import StationState, UnitState
from base_station.core.state.boot_state import BootState
from shared.messages import GpsFix


def station_ns(state: StationState, unit: UnitState, t_mono_ns: int) -> int:
    """The station's time of a time of the unit's path; not known yet: now."""
    return placed_ns(unit.path_boot, t_mono_ns, state.t_ns)


def placed_ns(boot: BootState, t_mono_ns: int, now_ns: int) -> int:
    """The station's time of a time of a boot, at the latest now; not known yet: now."""
    return min(boot.station_ns(t_mono_ns), now_ns) if boot.is_placed else now_ns


def in_clock_of_path(unit: UnitState, fix: GpsFix) -> GpsFix:
    """A unit that is tracked remotely has its fixes in its own clock, its path in another."""
    ahead_ns = unit.boots[-1].offset_ns - unit.path_boot.offset_ns
    if ahead_ns == 0:
        return fix
    t_mono_ns = fix.header.t_mono_ns + ahead_ns
    header = msgspec.structs.replace(fix.header, t_mono_ns=t_mono_ns)
    return msgspec.structs.replace(fix, header=header)
