"""Satellite fixes: screening, place in the incident frame, and update of the fusers."""

from __future__ import annotations

from collections.abc import Callable

from base_station.core.pins.pin_registry import resolve_later
from base_station.core.positioning.clocks import in_clock_of_path, station_ns
from base_station.core.positioning.unit_fusers import UnitFusers
from base_station.core.state import GpsUse, SiteState, StationState, UnitState
from base_station.fusion.gnss.common_mode_error import CommonModeError
from base_station.fusion.gnss.screening import in_incident_frame, may_anchor, screen_fix
from base_station.fusion.interface import Estimate, FixVerdict, PlaceFix
from shared.clock import NS_PER_S
from shared.geo import anchor_through
from shared.messages import GpsFix

FUTURE_NS = NS_PER_S  # a fix may be this much later than the station's estimate of the unit's clock
FAR_FIXES = 10  # in a row, contradicted by no other unit: then the first fix was wrong
BEFORE_SITE = "of before it came to this incident"
STAYS_M = 5.0  # walked at most by a unit that stays in place and is not carried about


LATE_NS = 5 * NS_PER_S  # an older fix came from a journal


def apply_fix(state: StationState, fusers: UnitFusers, unit: UnitState, fix: GpsFix) -> FixVerdict:
    """Apply a fix; the verdict gives the reason where it is not used."""
    place = place_fix(state, unit, fix, fusers.plain(unit).estimate)
    verdict = place if isinstance(place, FixVerdict) else _update_fusers(state, fusers, unit, place)
    unit.gps = _gps_after(unit.gps, verdict, state.t_ns)
    if verdict.reason:
        unit.count_rejected(verdict.reason)
    return verdict


def place_fix(
    state: StationState,
    unit: UnitState,
    fix: GpsFix,
    estimate: Callable[[], Estimate | None],
) -> PlaceFix | FixVerdict:
    """Fix in the incident frame, or the verdict that rejects it.

    Where neither plan nor person defines the frame, the first good fix sets the anchor so that no
    estimate moves (``estimate``: the present one). If all later fixes are far from it, that first
    fix was wrong and the anchor is set again, also without a movement.
    """
    verdict = screen_fix(fix)
    if not verdict.accepted:
        return verdict
    boot = unit.boots[-1]
    if fix.header.boot_id != boot.boot_id:
        return FixVerdict(False, "from an earlier run of the unit")
    if not boot.is_placed:
        return FixVerdict(False, "of a time that no other message has placed yet")
    t_ns = boot.station_ns(fix.header.t_mono_ns)
    if not unit.site_ns <= t_ns <= state.t_ns + FUTURE_NS:
        is_early = t_ns < unit.site_ns
        return FixVerdict(False, BEFORE_SITE if is_early else "from the future", not is_early)
    site = state.sites[unit.site_id]
    if site.anchor is None and not site.start_set and site.plan is None and may_anchor(fix):
        _set_anchor_by(site, fix, estimate())
    if site.anchor is None:
        return FixVerdict(False, "the site has no anchor")
    place = in_incident_frame(in_clock_of_path(unit, fix), site.anchor)
    if isinstance(place, PlaceFix):
        site.far_fixes = 0
    elif site.anchor_by_gps and may_anchor(fix):
        site.far_fixes += 1
        if site.far_fixes >= FAR_FIXES:
            _set_anchor_by(site, fix, estimate())
    return place


def _set_anchor_by(site: SiteState, fix: GpsFix, here: Estimate | None) -> None:
    here_m = (0.0, 0.0, 0.0) if here is None else (here.north_m, here.east_m, here.down_m)
    site.anchor = anchor_through(fix.lat_deg, fix.lon_deg, fix.height_m, here_m)
    site.anchor_by_gps, site.far_fixes, site.common_mode_error = True, 0, CommonModeError()


def without_common_mode_error(state: StationState, unit: UnitState, fix: PlaceFix) -> PlaceFix:
    """Fix without the common-mode error that the reference unit at the station shows."""
    t_ns = station_ns(state, unit, fix.t_mono_ns)
    site = state.sites[unit.site_id]
    if unit.unit_id != site.barometers.reference_id:
        return site.common_mode_error.correct(fix, t_ns)
    history = state.paths.get(unit.unit_id)
    start = None if history is None else history.start.position
    walked_m = unit.position.distance_m if unit.position is not None else 0.0
    if start is not None and walked_m < STAYS_M:
        off_m = fix.north_m - start.north_m, fix.east_m - start.east_m
        site.common_mode_error.update(t_ns, off_m, fix.horizontal_std_m, start.std_m)
    return fix


def _update_fusers(
    state: StationState, fusers: UnitFusers, unit: UnitState, place: PlaceFix
) -> FixVerdict:
    """Update the fusers.  The path is solved again later, with the raw fix and the station's
    receiver: soon if only pins contradict the fix.
    """
    own = without_common_mode_error(state, unit, place)
    verdict, *pinned = [fuser.update_gnss(own) for fuser in fusers.of(unit)]
    if verdict.accepted:
        site = state.sites[unit.site_id]
        site.fixes_anchor = site.anchor
        t_ns = station_ns(state, unit, place.t_mono_ns)
        state.path_of(unit.unit_id).fix(place, t_ns)
        contradicts_pins = not all(one.accepted for one in pinned)
        if contradicts_pins or t_ns < state.t_ns - LATE_NS:
            resolve_later(state, unit.unit_id)
    return verdict


def _gps_after(before: GpsUse | None, verdict: FixVerdict, t_ns: int) -> GpsUse:
    since_ns = before.faulty_since_ns if before is not None else None
    if not verdict.faulty:
        since_ns = None
    elif since_ns is None:
        since_ns = t_ns
    return GpsUse(t_ns, verdict.reason, since_ns)
