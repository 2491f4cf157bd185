"""A satellite fix on its way to a fuser: whether it can be true, and where it lies on the plan."""

from __future__ import annotations

from collections.abc import Callable

from base_station.fusion.fixes.screening import in_incident_frame, may_anchor, screen
from base_station.fusion.fixes.sky import Sky
from base_station.fusion.port import Estimate, FixVerdict, PlaceFix
from base_station.live_state import StationState, UnitState
from base_station.positioning.clocks import in_clock_of_path, station_ns
from shared.clock import NS_PER_S
from shared.geo import anchor_through
from shared.messages import GpsFix

FUTURE_NS = NS_PER_S  # a fix may be this much ahead of the station's idea of the unit's clock
FAR_FIXES = 10  # in a row that nobody's contradicts: it was the first one that was wrong
STAYS_M = 5.0  # walked by what stays where it is: nobody carries it about


def place_fix(
    state: StationState,
    unit: UnitState,
    fix: GpsFix,
    estimate: Callable[[], Estimate | None],
) -> PlaceFix | FixVerdict:
    """The fix in the incident frame, or why it is not used.

    Where neither a plan nor a person gives the frame a meaning, the first good fix does, so that
    nobody moves by it: ``estimate`` tells where the unit is then.  If all later ones are of
    elsewhere it was wrong, and the frame lies there; nobody moves by that either.
    """
    verdict = screen(fix)
    if not verdict.accepted:
        return verdict
    boot = unit.boots[-1]
    if fix.header.boot_id != boot.boot_id:
        return FixVerdict(False, "from an earlier run of the unit")
    if not boot.is_placed:
        return FixVerdict(False, "of a time that nothing else has told yet")
    if boot.station_ns(fix.header.t_mono_ns) > state.t_ns + FUTURE_NS:
        return FixVerdict(False, "from the future", faulty=True)
    if state.anchor is None and not state.start_set and state.plan is None and may_anchor(fix):
        _anchor_by(state, fix, estimate())
    if state.anchor is None:
        return FixVerdict(False, "the site has no anchor")
    place = in_incident_frame(in_clock_of_path(unit, fix), state.anchor)
    if isinstance(place, PlaceFix):
        state.far_fixes = 0
    elif state.anchor_by_gps and may_anchor(fix):
        state.far_fixes += 1
        if state.far_fixes >= FAR_FIXES:
            _anchor_by(state, fix, estimate())
    return place


def _anchor_by(state: StationState, fix: GpsFix, here: Estimate | None) -> None:
    here_m = (0.0, 0.0, 0.0) if here is None else (here.north_m, here.east_m, here.down_m)
    state.anchor = anchor_through(fix.lat_deg, fix.lon_deg, fix.height_m, here_m)
    state.anchor_by_gps, state.far_fixes, state.sky = True, 0, Sky()


def without_sky(state: StationState, unit: UnitState, fix: PlaceFix) -> PlaceFix:
    """The fix without what all receivers err by, as the unit tells that stays at the station and
    whose place somebody has said.
    """
    t_ns = station_ns(state, unit, fix.t_mono_ns)
    if unit.unit_id != state.barometers.reference_id:
        return state.sky.corrected(fix, t_ns)
    history = state.paths.get(unit.unit_id)
    start = None if history is None else history.start
    walked_m = unit.position.distance_m if unit.position is not None else 0.0
    if start is not None and walked_m < STAYS_M:
        off_m = fix.north_m - start.north_m, fix.east_m - start.east_m
        state.sky.note(t_ns, off_m, fix.horizontal_std_m, start.std_m)
    return fix
