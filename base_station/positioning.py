"""Brings every unit's own path and satellite fixes into the incident frame, with its floors.

Holds one fuser a unit, all of one kind; the anchor, the plan and what became of a fix are in
the live state.
"""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from base_station.fusion.port import Estimate, FixVerdict, Fuser, FuserKind, Start
from base_station.fusion.screening import in_incident_frame, may_anchor, screen
from base_station.live_state import StationState, TrailStep, UnitState
from shared.clock import NS_PER_S
from shared.geo import Anchor, anchor_through, rotate
from shared.messages import FusedPosition, GpsFix, Header, Position
from shared.quality import Quality

FUTURE_NS = NS_PER_S  # a fix may be this much ahead of the station's idea of the unit's clock
WORK_BEGINS_M = 5.0  # walked since the start: the wearer has gone in, where no plan can tell


class Positioning:
    """The fusers of all units."""

    def __init__(self, kind: FuserKind, saved: Mapping[str, bytes]) -> None:
        self._kind = kind
        self._fusers = {unit_id: kind.restore(state) for unit_id, state in saved.items()}

    def save(self) -> dict[str, bytes]:
        return {unit_id: fuser.save() for unit_id, fuser in self._fusers.items()}

    def follow(self, unit: UnitState, position: Position) -> None:
        _count(unit, self._fuser(unit).advance(position))

    def fix(self, state: StationState, unit: UnitState, fix: GpsFix) -> FixVerdict:
        verdict = self._judge_fix(state, unit, fix)
        _count(unit, verdict.reason)
        return verdict

    def start(self, state: StationState, unit: UnitState, start: Start) -> None:
        state.start_set = True
        self._fuser(unit).start(start)

    def forget(self, unit: UnitState) -> None:
        """Where its wearers were, and what was learnt of their walk."""
        self._fusers.pop(unit.unit_id, None)
        unit.fused, unit.position = None, None
        unit.trail.clear()

    def set_anchor(self, state: StationState, anchor: Anchor) -> None:
        """Say where the incident frame lies.  What was placed by hand stays where it is on the
        plan; what the first satellite fix had placed moves with the new anchor.
        """
        old = state.anchor
        if old is not None and state.anchor_by_gps:
            shift = anchor.to_incident_m(old.lat_deg, old.lon_deg, old.height_m)
            self._reframe(state, old.rotation_rad - anchor.rotation_rad, shift)
        state.anchor, state.anchor_by_gps = anchor, False

    def fused(self, state: StationState, unit: UnitState, header: Header) -> FusedPosition | None:
        """The unit's place as it is now; the live state, its trail included, follows it."""
        estimate = self._fuser(unit).estimate()
        if estimate is None:
            return None
        floor = None
        if state.plan is not None:
            held = unit.fused.floor if unit.fused is not None else None
            floor = state.plan.floor_at(estimate.down_m, held)
        unit.fused = _as_message(estimate, unit, self._kind.name, floor, header)
        unit.extend_trail(unit.fused)
        if unit.fused.quality is not Quality.LOST:
            unit.unplaced_since_ns = None
        elif unit.unplaced_since_ns is None:
            unit.unplaced_since_ns = state.t_ns
        _note_inside(state, unit)
        return unit.fused

    def recalled(
        self, state: StationState, unit: UnitState, position: Position, header: Header
    ) -> FusedPosition | None:
        """Where the wearer was at a position that came late; the trail is filled in there."""
        estimate = self._fuser(unit).recall(position)
        boot = unit.path_boot
        if estimate is None or boot.boot_id != position.header.boot_id or not boot.is_placed:
            return None
        floor = state.plan.floor_at(estimate.down_m, None) if state.plan is not None else None
        fused = _as_message(estimate, unit, self._kind.name, floor, header)
        unit.fill_trail(fused)
        return fused

    def _fuser(self, unit: UnitState) -> Fuser:
        fuser = self._fusers.get(unit.unit_id)
        if fuser is None:
            fuser = self._fusers[unit.unit_id] = self._kind.new()
        return fuser

    def _judge_fix(self, state: StationState, unit: UnitState, fix: GpsFix) -> FixVerdict:
        verdict = screen(fix)
        if not verdict.accepted:
            return verdict
        boot = unit.boots[-1]
        if boot.is_placed and boot.station_ns(fix.header.t_mono_ns) > state.t_ns + FUTURE_NS:
            return FixVerdict(False, "from the future")
        if state.anchor is None and not self._anchor_itself(state, unit, fix):
            return FixVerdict(False, "the site has no anchor")
        assert state.anchor is not None
        place = in_incident_frame(_in_clock_of_path(unit, fix), state.anchor)
        return place if isinstance(place, FixVerdict) else self._fuser(unit).correct(place)

    def _anchor_itself(self, state: StationState, unit: UnitState, fix: GpsFix) -> bool:
        """Where neither a plan nor a person gives the frame a meaning, the first good fix does,
        so that nobody moves by it.
        """
        if state.plan is not None or state.start_set or not may_anchor(fix):
            return False
        estimate = self._fuser(unit).estimate()
        here_m = (0.0, 0.0, 0.0)
        if estimate is not None:
            here_m = (estimate.north_m, estimate.east_m, estimate.down_m)
        state.anchor = anchor_through(fix.lat_deg, fix.lon_deg, fix.height_m, here_m)
        state.anchor_by_gps = True
        return True

    def _reframe(
        self, state: StationState, turn_rad: float, shift_m: tuple[float, float, float]
    ) -> None:
        for fuser in self._fusers.values():
            fuser.reframe(turn_rad, *shift_m)
        for unit in state.units.values():
            unit.trail = [_moved(step, turn_rad, shift_m) for step in unit.trail]


def _moved(step: TrailStep, turn_rad: float, shift_m: tuple[float, float, float]) -> TrailStep:
    north_m, east_m = rotate(step.north_m, step.east_m, turn_rad)
    return msgspec.structs.replace(step, north_m=north_m + shift_m[0], east_m=east_m + shift_m[1])


def _in_clock_of_path(unit: UnitState, fix: GpsFix) -> GpsFix:
    """A unit that is tracked remotely has its fixes in its own clock, its path in another."""
    ahead_ns = unit.boots[-1].offset_ns - unit.path_boot.offset_ns
    if ahead_ns == 0:
        return fix
    t_mono_ns = fix.header.t_mono_ns + ahead_ns
    header = msgspec.structs.replace(fix.header, t_mono_ns=t_mono_ns)
    return msgspec.structs.replace(fix, header=header)


def _count(unit: UnitState, reason: str) -> None:
    if reason:
        unit.not_used[reason] = unit.not_used.get(reason, 0) + 1


def _as_message(
    estimate: Estimate, unit: UnitState, fuser: str, floor: int | None, header: Header
) -> FusedPosition:
    return FusedPosition(
        header=header,
        unit_id=unit.unit_id,
        t_meas_ns=min(unit.path_boot.station_ns(estimate.t_mono_ns), header.t_utc_ns),
        north_m=estimate.north_m,
        east_m=estimate.east_m,
        down_m=estimate.down_m,
        std_north_m=estimate.std_north_m,
        std_east_m=estimate.std_east_m,
        std_down_m=estimate.std_down_m,
        correlation_ne=estimate.correlation_ne,
        heading_rad=estimate.heading_rad,
        heading_std_rad=estimate.heading_std_rad,
        floor=floor,
        quality=estimate.quality,
        quality_reason=estimate.quality_reason,
        fuser=fuser,
        since_gps_s=estimate.since_gps_s,
    )


def _note_inside(state: StationState, unit: UnitState) -> None:
    """Since when the wearer is in the building; without an outline, since work began."""
    fused = unit.fused
    if fused is None:
        return
    if state.plan is not None and state.plan.outlines:
        was_inside = unit.inside_since_ns is not None
        is_inside = state.plan.is_inside(fused.north_m, fused.east_m, was_inside)
    else:
        at_work = state.incident is not None and state.incident.closed_ns is None
        walked_m = unit.position.distance_m if unit.position else 0.0
        is_inside = at_work and (unit.inside_since_ns is not None or walked_m > WORK_BEGINS_M)
    if not is_inside:
        unit.inside_since_ns = None
    elif unit.inside_since_ns is None:
        unit.inside_since_ns = state.t_ns
