"""Brings every unit's own path and satellite fixes into the incident frame, with its floors.

Holds one fuser a unit, all of one kind; the anchor, the plan and what became of a fix are in
the live state.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

from base_station.fusion.fixes.screening import FURTHEST_M
from base_station.fusion.fixes.sky import Sky
from base_station.fusion.learnt.building import LearntBuilding
from base_station.fusion.path.history import PathHistory
from base_station.fusion.plane.compass import bearing_of
from base_station.fusion.port import Bearing, FixVerdict, Fuser, FuserKind, PlaceFix, Start
from base_station.fusion.smoother.port import Smoother
from base_station.live_state import GpsUse, StationState, UnitState
from base_station.pins.book import drop, has_pins, units_of
from base_station.pins.debriefing import is_about
from base_station.pins.evidence import floors_said
from base_station.pins.late_history import note_late
from base_station.pins.pinned_units import PinnedUnits
from base_station.pins.pinning import numbered_again
from base_station.positioning.anchor_correction import move_fixes, place_again
from base_station.positioning.clocks import station_ns
from base_station.positioning.fixes import place_fix, without_sky
from base_station.positioning.frame import moved_by, reframe
from base_station.positioning.fused_message import fused_message
from base_station.positioning.inside import is_outside, note_inside
from base_station.positioning.lost_contact import LostContact
from base_station.positioning.said_place import as_said
from base_station.positioning.unit_starts import begin, lead_on, unlearn
from base_station.site.floor_grid import FloorGrid
from base_station.site.learnt_floors import BEGAN_M, Landing
from base_station.site.plan import Plan, Ring
from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.messages import FusedPosition, GpsFix, Header, Position
from shared.quality import Quality

LATE_NS = 5 * NS_PER_S  # a fix of so long ago came out of a journal


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
        self._lost_contact = LostContact(None)
        self._pinned = PinnedUnits(kind, smoother, saved_pinned)

    def consider(self, plan: Plan | None) -> None:
        """What stands in everybody's way, from now on."""
        self._grid = FloorGrid.of(plan)
        self._lost_contact = LostContact(self._grid)
        self._pinned.grid = self._grid
        for fuser in (*self._fusers.values(), *self._pinned.all()):
            fuser.consider(self._grid)

    def reach(self, state: StationState, unit: UnitState) -> Ring:
        """``LostContact.reach`` of now."""
        return self._lost_contact.reach(state.t_ns, unit)

    def save(self) -> dict[str, bytes]:
        return {unit_id: fuser.save() for unit_id, fuser in self._fusers.items()}

    def save_pinned(self) -> dict[str, bytes]:
        return self._pinned.save()

    def follow(self, state: StationState, unit: UnitState, position: Position) -> bool:
        """Whether pins had waited for it: the past is to be solved again."""
        told = self._told(unit)
        fuser, history = told[0], _history(state, unit)
        t_ns = station_ns(state, unit, position.header.t_mono_ns)
        away_s = math.inf if history.end_ns is None else (t_ns - history.end_ns) / NS_PER_S
        reason = fuser.advance(position, away_s)
        if reason:
            _count(unit, reason)
        for one in told[1:]:
            one.advance(position, away_s)
        outside = is_outside(state.laid_plan, history)
        air = state.barometers.hear(unit.unit_id, t_ns, position, is_outside=outside)
        bearing = _bearing(state, position)
        for one in told:
            if air is not None:
                one.feel(air)
            if bearing is not None:
                one.face(bearing)
        state.learnt_building = fuser.recognise(state.learnt_building)
        for one in told[1:]:
            one.recognise(state.learnt_building)
        begins = history.note(position, t_ns, bool(reason))
        if state.learnt_floors.follow(position, unit.unit_id):
            self._land(state, unit, t_ns, outside)
        return history.is_awaited or (begins and has_pins(state, unit.unit_id))

    def solve_pins(self, state: StationState, unit_ids: Collection[str]) -> dict[str, bool]:
        """Pins of these units changed; gives whose present hangs on that, and whether the trail
        is another now.  A floor that is said numbers the storeys of everybody in that building,
        and that of a pin which turns out to contradict does not.
        """
        floors = state.learnt_floors
        numbers, storeys = floors.numbers, floors.storeys
        floors.say(floors_said(state, unit_ids))
        past = self._pinned.past()
        units = [state.units[one] for one in unit_ids if one in state.units]
        again = [one for one in units if place_again(state, one, self._fuser(one), past)]
        solved = self._pinned.solve(state, unit_ids, lambda one: self._fuser(state.units[one]))
        if floors.say(floors_said(state)):
            solved |= self._pinned.solve(state, unit_ids, lambda one: self._fuser(state.units[one]))
        solved |= {unit.unit_id: True for unit in again}
        if floors.numbers != numbers:
            self.renumber(state)
        if floors.storeys != storeys:
            shown = [one for one, unit in state.units.items() if unit.fused is not None]
            for unit_id in shown:
                if unit_id not in solved:
                    solved[unit_id] = False
                    _note_late(state, state.units[unit_id])
        return solved

    def renumber(self, state: StationState) -> None:
        """Storeys have other numbers now: those along every trail are said anew, one by one."""
        for history in state.paths.values():
            history.is_renumbered = True

    def number_one_again(self, state: StationState) -> str | None:
        """The next trail that waits for it; gives whose it is, where it is drawn otherwise now."""
        unit_id = next((one for one, path in state.paths.items() if path.is_renumbered), None)
        if unit_id is None:
            return None
        history, unit = state.paths[unit_id], state.units[unit_id]
        history.is_renumbered = False
        plain = unit.trail if unit.plain_trail is None else unit.plain_trail
        if history.begin_ns is None or not plain:
            return None
        before = plain.copy()
        plain[:] = numbered_again(state, plain, history.arrays())
        return unit_id if plain is unit.trail and plain != before else None

    def begin_incident(self, state: StationState, before_ns: int) -> set[str]:
        """What was known of paths and pins before that time no longer matters; gives whose past
        that changes.
        """
        state.learnt_floors.trim(before_ns)
        state.learnt_building = LearntBuilding()
        for history in state.paths.values():
            history.begin_incident(state.t_ns, before_ns)
        for unit in state.units.values():
            if unit.plain_trail is not None:
                unit.plain_trail.clear()
        kept = set().union(*map(units_of, state.pins.values()))
        return kept | drop(state, lambda pin: is_about(pin, before_ns))

    def fix(self, state: StationState, unit: UnitState, fix: GpsFix) -> FixVerdict:
        """Whether the fix is used, and why not."""
        place = place_fix(state, unit, fix, self._fuser(unit).estimate)
        verdict = place if isinstance(place, FixVerdict) else self._correct(state, unit, place)
        unit.gps = _gps_after(unit.gps, verdict, state.t_ns)
        _count(unit, verdict.reason)
        return verdict

    def start(self, state: StationState, unit: UnitState, start: Start) -> None:
        """On the plan, where there is one that people lie on (``lay_on_plan``)."""
        state.start_set = True
        if unit.unit_id == state.barometers.reference_id:
            state.sky = Sky()
        history = _history(state, unit)
        if history.is_before_incident and unit.link != "live":  # of the run that is to come
            self._fusers.pop(unit.unit_id, None)
            self._pinned.forget(unit)
            history = state.paths[unit.unit_id] = history.of_next_run()
            unlearn(state, unit.unit_id)
        begin(state, unit, self._fuser(unit), history, start)

    def lay_on_plan(self, state: StationState) -> set[str]:
        """A person has said a place on the plan, and nobody had said any before: the frame is the
        plan's, and where satellites had people tells nothing in it.  Gives whose past that changes.
        """
        state.anchor, state.anchor_by_gps, state.sky = None, False, Sky()
        self.consider(state.laid_plan)
        for unit_id, history in state.paths.items():
            unit, before = state.units[unit_id], self._fusers.pop(unit_id, None)
            self._pinned.forget(unit)
            history.leave_satellites()
            unlearn(state, unit_id)
            unit.change_plain_trail(0, [])
            if unit.position is None:
                unit.fused = None
                continue
            self._fuser(unit).advance(unit.position)
            was = None if before is None else before.estimate()
            lead_on(state, unit, self._fuser(unit), history, was)
        return set(state.paths)

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
        plan; what the first satellite fix had placed moves with the new anchor, unless that fix was
        of nowhere near.
        """
        old = state.anchor
        if old is not None and old != anchor:
            move = moved_by(anchor, old, state.fixes_anchor)
            if state.anchor_by_gps and math.hypot(move.north_m, move.east_m) <= FURTHEST_M:
                for fuser in (*self._fusers.values(), *self._pinned.all()):
                    fuser.reframe(move.turn_rad, move.north_m, move.east_m, move.down_m)
                reframe(state, move)
            else:
                move_fixes(state, move.turn_rad, move.north_m, move.east_m)
        state.anchor, state.anchor_by_gps, state.sky = anchor, False, Sky()
        self.consider(state.laid_plan)

    def fused(self, state: StationState, unit: UnitState, header: Header) -> FusedPosition | None:
        """The unit's place as it is now; the live state, its trail included, follows it."""
        estimate = self._fuser(unit).estimate()
        if estimate is None:
            return None
        held = unit.fused.floor if unit.fused is not None else None
        history = state.paths.get(unit.unit_id)
        was = held if history is None else history.floor
        boot = unit.path_boot
        plain = fused_message(state, unit, boot, estimate, self._kind.name, was, header)
        is_drawn = _is_drawn(state, plain)
        if is_drawn:
            unit.extend_plain_trail(plain)
        unit.fused, pinned = plain, self._pinned.get(unit.unit_id)
        if pinned is not None:
            known = pinned.estimate() or estimate
            unit.fused = fused_message(state, unit, boot, known, self._kind.name, held, header)
        if is_drawn:
            unit.extend_trail(unit.fused)
        unit.reach = ()
        if history is not None:
            history.show(estimate, plain.floor)
            unit.fused = as_said(state, history, unit.fused)
        if unit.fused.quality is not Quality.LOST:
            unit.unplaced_since_ns = None
        elif unit.unplaced_since_ns is None:
            unit.unplaced_since_ns = state.t_ns
        note_inside(state, unit)
        return unit.fused

    def recalled(
        self, state: StationState, unit: UnitState, position: Position, header: Header
    ) -> FusedPosition | None:
        """Where the wearer was at a position that came late; the trail is filled in there.  Said
        once for each second, as trails and the store keep it.
        """
        boot, running = unit.path_boot_of(position), unit.path_boot
        if boot is None or not boot.is_placed:
            return None
        t_ns = boot.station_ns(position.header.t_mono_ns)
        if boot is not running and t_ns >= running.there_from_ns:
            return None  # another machine under the same name
        fuser, pinned = self._fuser(unit), self._pinned.get(unit.unit_id)
        fuser.remember(position)
        if pinned is not None:
            pinned.remember(position)
        second = t_ns // NS_PER_S
        if second == unit.recalled_s:
            return None
        estimate = fuser.recall(position)
        if estimate is None:
            return None
        unit.recalled_s = second
        fused = plain = fused_message(state, unit, boot, estimate, self._kind.name, None, header)
        is_drawn = _is_drawn(state, plain)
        if is_drawn:
            unit.fill_plain_trail(plain)
        known = None if pinned is None else pinned.recall(position)
        if known is not None:
            fused = fused_message(state, unit, boot, known, self._kind.name, None, header)
        if is_drawn:
            unit.fill_trail(fused)
        if unit.unit_id in state.paths:
            state.paths[unit.unit_id].fill(position, plain.t_meas_ns, estimate, plain.floor)
        _note_late(state, unit)
        return fused

    def _land(self, state: StationState, unit: UnitState, t_ns: int, outside: bool) -> None:
        """The wearer walks on the level: a storey is learnt of it, or its height of a storey."""
        estimate = self._fuser(unit).estimate()
        if estimate is None:
            return
        place = estimate.north_m, estimate.east_m
        start = state.paths[unit.unit_id].start
        state.learnt_floors.land(
            Landing(t_ns, unit.unit_id, *place, estimate.down_m, estimate.std_down_m),
            is_outside=outside,
            began_on_ground=start is None or abs(start.down_m) < BEGAN_M,
        )
        if self._grid is None:  # else the fuser knows the plan's storeys, and when it is inside
            storeys = [one for one in state.storeys_at(*place) if one.seen]
            for fuser in self._told(unit):
                fuser.rest_on(storeys)

    def _correct(self, state: StationState, unit: UnitState, place: PlaceFix) -> FixVerdict:
        """The past is solved again with the fix as it came, and with the station's receiver; soon
        where the fix fits all but the pins.
        """
        own = without_sky(state, unit, place)
        verdict, *pinned = [fuser.correct(own) for fuser in self._told(unit)]
        if verdict.accepted:
            state.fixes_anchor = state.anchor
            t_ns = station_ns(state, unit, place.t_mono_ns)
            _history(state, unit).fix(place, t_ns)
            contradicts_pins = not all(one.accepted for one in pinned)
            if contradicts_pins or t_ns < state.t_ns - LATE_NS:
                _note_late(state, unit)
        return verdict

    def _told(self, unit: UnitState) -> tuple[Fuser, ...]:
        """Who hears of a unit: the fuser that knows no pins, and the one that does, if any."""
        pinned = self._pinned.get(unit.unit_id)
        return (self._fuser(unit),) if pinned is None else (self._fuser(unit), pinned)

    def _fuser(self, unit: UnitState) -> Fuser:
        fuser = self._fusers.get(unit.unit_id)
        if fuser is None:
            fuser = self._fusers[unit.unit_id] = self._kind.new()
            fuser.consider(self._grid)
        return fuser


def _history(state: StationState, unit: UnitState) -> PathHistory:
    history = state.paths.get(unit.unit_id)
    if history is None:
        history = state.paths[unit.unit_id] = PathHistory()
    return history


def _is_drawn(state: StationState, fused: FusedPosition) -> bool:
    """Whether it belongs to the incident that is shown."""
    return state.incident is None or fused.t_meas_ns >= state.incident.opened_ns


def _bearing(state: StationState, position: Position) -> Bearing | None:
    """What the unit's compass tells, where it is known which way the plan lies on the Earth."""
    if position.magnetic_north is None or state.anchor is None:
        return None
    return bearing_of(position.magnetic_north, state.anchor, state.t_ns)


def _note_late(state: StationState, unit: UnitState) -> None:
    if has_pins(state, unit.unit_id):
        note_late(state.late, unit.unit_id, state.t_ns)


def _gps_after(before: GpsUse | None, verdict: FixVerdict, t_ns: int) -> GpsUse:
    since_ns = before.faulty_since_ns if before is not None else None
    if not verdict.faulty:
        since_ns = None
    elif since_ns is None:
        since_ns = t_ns
    return GpsUse(t_ns, verdict.reason, since_ns)


def _count(unit: UnitState, reason: str) -> None:
    if reason:
        unit.not_used[reason] = unit.not_used.get(reason, 0) + 1
