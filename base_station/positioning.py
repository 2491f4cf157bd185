"""Brings every unit's own path and satellite fixes into the incident frame, with its floors.

Holds one fuser a unit, all of one kind; the anchor, the plan and what became of a fix are in
the live state.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import msgspec

from base_station.fusion.fixes.screening import in_incident_frame, may_anchor, screen
from base_station.fusion.fixes.sky import Sky
from base_station.fusion.learnt.building import LearntBuilding
from base_station.fusion.path.history import PathHistory
from base_station.fusion.plane.compass import bearing_of
from base_station.fusion.port import (
    Bearing,
    Estimate,
    FixVerdict,
    Fuser,
    FuserKind,
    PlaceFix,
    Start,
)
from base_station.fusion.smoother.port import Smoother
from base_station.live_state import StationState, TrailStep, UnitState
from base_station.pins.book import has_pins, reframe_pins
from base_station.pins.late import note_late
from base_station.pins.pinned import PinnedUnits
from base_station.pins.pinning import floors_said
from base_station.site.floor_grid import FloorGrid
from base_station.site.learnt_floors import BEGAN_M, Landing
from base_station.site.plan import Plan, Ring
from base_station.site.roaming import RADII_95, roamed_m
from base_station.site.storeys import floor_at, sureness
from shared.clock import NS_PER_S
from shared.geo import Anchor, anchor_through, rotate
from shared.messages import FusedPosition, GpsFix, Header, Position
from shared.quality import Quality

LATE_NS = 5 * NS_PER_S  # a fix of so long ago came out of a journal
FUTURE_NS = NS_PER_S  # a fix may be this much ahead of the station's idea of the unit's clock
OUTSIDE_M = 3.0  # from the outer walls: the weather's pressure
OUTSIDE_FIX_S = 5.0  # where no plan is known, as long after a fix
STAYS_M = 5.0  # walked by what stays where it is: nobody carries it about
WORK_BEGINS_M = 5.0  # walked since the start: the wearer has gone in, where no plan can tell


class Positioning:
    """The fusers of all units."""

    def __init__(
        self,
        kind: FuserKind,
        smoother: Smoother,
        saved: Mapping[str, bytes],
        saved_pinned: Mapping[str, bytes],
    ) -> None:
        self._kind = kind
        self._fusers = {unit_id: kind.restore(state) for unit_id, state in saved.items()}
        self._grid: FloorGrid | None = None
        self._pinned = PinnedUnits(kind, smoother, saved_pinned)

    def consider(self, plan: Plan | None) -> None:
        """What stands in everybody's way, from now on."""
        self._grid = FloorGrid.of(plan)
        self._pinned.grid = self._grid
        for fuser in (*self._fusers.values(), *self._pinned.all()):
            fuser.consider(self._grid)

    def reach(self, state: StationState, unit: UnitState) -> Ring:
        """The border of what somebody who is not heard can have walked to since, on the floor
        where that was; empty where no plan tells, or somebody is heard.
        """
        fused = unit.fused
        if self._grid is None or fused is None or fused.floor is None or unit.link == "live":
            return ()
        known_m = RADII_95 * max(fused.std_north_m, fused.std_east_m)
        way_m = known_m + roamed_m((state.t_ns - fused.t_meas_ns) / NS_PER_S)
        return self._grid.reach(fused.floor, fused.north_m, fused.east_m, way_m)

    def save(self) -> dict[str, bytes]:
        return {unit_id: fuser.save() for unit_id, fuser in self._fusers.items()}

    def save_pinned(self) -> dict[str, bytes]:
        return self._pinned.save()

    def follow(self, state: StationState, unit: UnitState, position: Position) -> list[str]:
        """Gives the units whose past was solved again because this one has gone on."""
        fuser = self._fuser(unit)
        reason = fuser.advance(position)
        if reason:
            _count(unit, reason)
        t_ns = _station_ns(state, unit, position.header.t_mono_ns)
        is_outside = _is_outside(state, unit)
        air = state.barometers.hear(unit.unit_id, t_ns, position, is_outside=is_outside)
        if air is not None:
            fuser.feel(air)
        bearing = _bearing(state, position)
        if bearing is not None:
            fuser.face(bearing)
        state.learnt_building = fuser.recognise(state.learnt_building)
        history = _history(state, unit)
        begins = history.end_ns is None
        history.note(position, t_ns, bool(reason))
        pinned = self._pinned.get(unit.unit_id)
        if pinned is not None:
            pinned.advance(position)
            if air is not None:
                pinned.feel(air)
            if bearing is not None:
                pinned.face(bearing)
            pinned.recognise(state.learnt_building)
        if state.learnt_floors.follow(position, unit.unit_id):
            self._land(state, unit, t_ns, is_outside)
        if history.is_awaited or (begins and has_pins(state, unit.unit_id)):
            return self.solve_pins(state, [unit.unit_id])
        return []

    def solve_pins(self, state: StationState, unit_ids: Iterable[str]) -> list[str]:
        """Pins of these units changed; gives those whose trail did."""
        state.learnt_floors.say(floors_said(state))
        return self._pinned.solve(state, unit_ids, lambda one: self._fuser(state.units[one]))

    def begin_incident(self, state: StationState, before_ns: int) -> None:
        """What was known of paths and pins before that time no longer matters."""
        state.learnt_floors.trim(before_ns)
        state.learnt_building = LearntBuilding()
        for history in state.paths.values():
            history.trim(before_ns)
        old = [pin.pin_id for pin in state.pins.values() if pin.set_ns <= before_ns]
        for pin_id in old:
            del state.pins[pin_id]
            state.pin_verdicts.pop(pin_id, None)
        for unit in state.units.values():
            if unit.plain_trail is not None:
                unit.plain_trail.clear()
        self.solve_pins(state, list(state.units))

    def fix(self, state: StationState, unit: UnitState, fix: GpsFix) -> FixVerdict:
        verdict = self._judge_fix(state, unit, fix)
        _count(unit, verdict.reason)
        return verdict

    def start(self, state: StationState, unit: UnitState, start: Start) -> None:
        state.start_set = True
        if unit.unit_id == state.barometers.reference_id:
            state.sky = Sky()
        self._fuser(unit).start(start)
        _history(state, unit).begin_with(start)
        self.solve_pins(state, [unit.unit_id])

    def forget(self, state: StationState, unit: UnitState) -> None:
        """Where its wearers were, and what was learnt of their walk."""
        self._fusers.pop(unit.unit_id, None)
        self._pinned.forget(unit)
        state.paths.pop(unit.unit_id, None)
        state.learnt_floors.forget(unit.unit_id)
        state.learnt_building = state.learnt_building.without(unit.unit_id)
        state.late.pop(unit.unit_id, None)
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
        state.anchor, state.anchor_by_gps, state.sky = anchor, False, Sky()

    def fused(self, state: StationState, unit: UnitState, header: Header) -> FusedPosition | None:
        """The unit's place as it is now; the live state, its trail included, follows it."""
        estimate = self._fuser(unit).estimate()
        if estimate is None:
            return None
        held = unit.fused.floor if unit.fused is not None else None
        pinned = self._pinned.get(unit.unit_id)
        if pinned is None:
            unit.fused = plain = self._message(state, unit, estimate, held, header)
        else:
            trail = unit.plain_trail or []
            was = trail[-1].floor if trail else held
            plain = self._message(state, unit, estimate, was, header)
            unit.extend_plain_trail(plain)
            unit.fused = self._message(state, unit, pinned.estimate() or estimate, held, header)
        unit.reach = ()
        unit.extend_trail(unit.fused)
        history = state.paths.get(unit.unit_id)
        if history is not None:
            history.show(estimate, plain.floor)
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
        self._fuser(unit).remember(position)
        fused = self._message(state, unit, estimate, None, header)
        unit.fill_plain_trail(fused)
        pinned = self._pinned.get(unit.unit_id)
        known = None if pinned is None else pinned.recall(position)
        if pinned is not None and known is not None:
            pinned.remember(position)
            fused = self._message(state, unit, known, None, header)
        unit.fill_trail(fused)
        if unit.unit_id in state.paths:
            state.paths[unit.unit_id].fill(position, fused.t_meas_ns)
        _note_late(state, unit)
        return fused

    def _message(
        self,
        state: StationState,
        unit: UnitState,
        estimate: Estimate,
        held: int | None,
        header: Header,
    ) -> FusedPosition:
        """``held``: the floor it was on, where that is known."""
        storeys = state.storeys_at(estimate.north_m, estimate.east_m)
        floor = floor_at(storeys, estimate.down_m, held)
        sure = None
        if floor is not None:
            sure = sureness(storeys, floor, estimate.down_m, estimate.std_down_m)
        return _as_message(estimate, unit, self._kind.name, (floor, sure), header)

    def _land(self, state: StationState, unit: UnitState, t_ns: int, is_outside: bool) -> None:
        """The wearer walks on the level: a storey is learnt of it, or its height of a storey."""
        estimate = self._fuser(unit).estimate()
        if estimate is None:
            return
        place = estimate.north_m, estimate.east_m
        start = state.paths[unit.unit_id].start
        state.learnt_floors.land(
            Landing(t_ns, unit.unit_id, *place, estimate.down_m, estimate.std_down_m),
            is_outside=is_outside,
            began_on_ground=start is None or abs(start.down_m) < BEGAN_M,
        )
        if self._grid is None:  # else the fuser knows the plan's storeys, and when it is inside
            storeys = [one for one in state.storeys_at(*place) if one.seen]
            self._fuser(unit).rest_on(storeys)
            pinned = self._pinned.get(unit.unit_id)
            if pinned is not None:
                pinned.rest_on(storeys)

    def _fuser(self, unit: UnitState) -> Fuser:
        fuser = self._fusers.get(unit.unit_id)
        if fuser is None:
            fuser = self._fusers[unit.unit_id] = self._kind.new()
            fuser.consider(self._grid)
        return fuser

    def _judge_fix(self, state: StationState, unit: UnitState, fix: GpsFix) -> FixVerdict:
        verdict = screen(fix)
        if not verdict.accepted:
            return verdict
        boot = unit.boots[-1]
        if fix.header.boot_id != boot.boot_id:
            return FixVerdict(False, "from an earlier run of the unit")
        if boot.is_placed and boot.station_ns(fix.header.t_mono_ns) > state.t_ns + FUTURE_NS:
            return FixVerdict(False, "from the future")
        if state.anchor is None and not self._anchor_itself(state, unit, fix):
            return FixVerdict(False, "the site has no anchor")
        assert state.anchor is not None
        place = in_incident_frame(_in_clock_of_path(unit, fix), state.anchor)
        if isinstance(place, FixVerdict):
            return place
        place = _without_sky(state, unit, place)
        verdict = self._fuser(unit).correct(place)
        pinned = self._pinned.get(unit.unit_id)
        if pinned is not None:
            pinned.correct(place)
        if verdict.accepted:
            history = _history(state, unit)
            t_ns = _station_ns(state, unit, place.t_mono_ns)
            history.fix(place, t_ns)
            if t_ns < state.t_ns - LATE_NS:
                _note_late(state, unit)
        return verdict

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
        for fuser in (*self._fusers.values(), *self._pinned.all()):
            fuser.reframe(turn_rad, *shift_m)
        for history in state.paths.values():
            history.reframe(turn_rad, *shift_m)
        for unit in state.units.values():
            unit.trail = [_moved(step, turn_rad, shift_m) for step in unit.trail]
            if unit.plain_trail is not None:
                unit.plain_trail = [_moved(step, turn_rad, shift_m) for step in unit.plain_trail]
        state.learnt_building = state.learnt_building.reframed(turn_rad, *shift_m[:2])
        reframe_pins(state, turn_rad, shift_m[0], shift_m[1])
        state.learnt_floors.reframe(turn_rad, *shift_m)


def _history(state: StationState, unit: UnitState) -> PathHistory:
    history = state.paths.get(unit.unit_id)
    if history is None:
        history = state.paths[unit.unit_id] = PathHistory()
    return history


def _moved(step: TrailStep, turn_rad: float, shift_m: tuple[float, float, float]) -> TrailStep:
    north_m, east_m = rotate(step.north_m, step.east_m, turn_rad)
    return msgspec.structs.replace(step, north_m=north_m + shift_m[0], east_m=east_m + shift_m[1])


def _without_sky(state: StationState, unit: UnitState, fix: PlaceFix) -> PlaceFix:
    """The fix without what all receivers err by, as the unit tells that stays at the station and
    whose place somebody has said.
    """
    t_ns = _station_ns(state, unit, fix.t_mono_ns)
    if unit.unit_id != state.barometers.reference_id:
        return state.sky.corrected(fix, t_ns)
    history = state.paths.get(unit.unit_id)
    start = None if history is None else history.start
    walked_m = unit.position.distance_m if unit.position is not None else 0.0
    if start is not None and walked_m < STAYS_M:
        off_m = fix.north_m - start.north_m, fix.east_m - start.east_m
        state.sky.note(t_ns, off_m, fix.horizontal_std_m, start.std_m)
    return fix


def _bearing(state: StationState, position: Position) -> Bearing | None:
    """What the unit's compass tells, where it is known which way the plan lies on the Earth."""
    if position.magnetic_north is None or state.anchor is None:
        return None
    return bearing_of(position.magnetic_north, state.anchor, state.t_ns)


def _in_clock_of_path(unit: UnitState, fix: GpsFix) -> GpsFix:
    """A unit that is tracked remotely has its fixes in its own clock, its path in another."""
    ahead_ns = unit.boots[-1].offset_ns - unit.path_boot.offset_ns
    if ahead_ns == 0:
        return fix
    t_mono_ns = fix.header.t_mono_ns + ahead_ns
    header = msgspec.structs.replace(fix.header, t_mono_ns=t_mono_ns)
    return msgspec.structs.replace(fix, header=header)


def _station_ns(state: StationState, unit: UnitState, t_mono_ns: int) -> int:
    """The station's time of a time of the unit's path; not known yet: now."""
    boot = unit.path_boot
    return min(boot.station_ns(t_mono_ns), state.t_ns) if boot.is_placed else state.t_ns


def _note_late(state: StationState, unit: UnitState) -> None:
    if has_pins(state, unit.unit_id):
        note_late(state.late, unit.unit_id, state.t_ns)


def _count(unit: UnitState, reason: str) -> None:
    if reason:
        unit.not_used[reason] = unit.not_used.get(reason, 0) + 1


def _as_message(
    estimate: Estimate,
    unit: UnitState,
    fuser: str,
    storey: tuple[int | None, float | None],
    header: Header,
) -> FusedPosition:
    """``storey``: the floor and how probable it is, where they are known."""
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
        floor=storey[0],
        quality=estimate.quality,
        quality_reason=estimate.quality_reason,
        fuser=fuser,
        since_gps_s=estimate.since_gps_s,
        floor_probability=storey[1],
    )


def _is_outside(state: StationState, unit: UnitState) -> bool:
    """Whether its barometer feels the weather, and no doors and fans of the building; no pin may
    matter for that, or what is without pins would not be what it would be.
    """
    fused, history = unit.fused, state.paths.get(unit.unit_id)
    shown_m = None if history is None else history.shown_m
    if fused is None or shown_m is None:
        return False
    if state.plan is not None and state.plan.outlines:
        return state.plan.depth_m(*shown_m) < -OUTSIDE_M
    return fused.since_gps_s is not None and fused.since_gps_s < OUTSIDE_FIX_S


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
