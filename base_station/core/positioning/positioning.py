"""Positions of all units: the stages of a position, and the changes of frame, map and incident.

Admission and ordering come before these stages, and alarms after them (``core.unit_messages``).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

from base_station.core.events import Output, PinsChanged, TrailBackfilled, UnitChanged
from base_station.core.pins.incident_scope import is_about
from base_station.core.pins.pin_registry import drop, has_pins, resolve_later, units_of
from base_station.core.positioning.anchor_correction import move_fixes
from base_station.core.positioning.fixes import BEFORE_SITE, apply_fix
from base_station.core.positioning.frame import moved_by, reframe
from base_station.core.positioning.fuse_stages import (
    PositionUpdate,
    extend_path,
    learn_storey,
    match_building,
    place_in_time,
    predict,
    update_height_and_heading,
)
from base_station.core.positioning.locate_stages import (
    LocationUpdate,
    apply_reported_place,
    extend_trails,
    find_earlier_floor,
    find_floor,
    insert_into_trails,
    keep_in_path,
    note_inside,
    show,
)
from base_station.core.positioning.lost_contact import LostContact
from base_station.core.positioning.solved_paths import renumber, renumber_next_trail, solve_pins
from base_station.core.positioning.start_position import begin, drop_learnt, replay_from_start
from base_station.core.positioning.unit_fusers import UnitFusers
from base_station.core.state import OWN_SITE_ID, StationState, UnitState
from base_station.core.state.boot_state import BootState
from base_station.core.state.unit_place import UnitPlace
from base_station.fusion import fuser_named
from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.gnss.common_mode_error import CommonModeError
from base_station.fusion.interface import MAX_FIX_DISTANCE_M, Fuser, FuserKind, Start
from base_station.fusion.smoothing.interface import Smoother
from base_station.site.plan import Ring
from base_station.site.plan_reader import PlanReader
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages import GpsFix, Position

FUSE = (
    place_in_time,
    predict,  # walls of the plan included
    update_height_and_heading,
    match_building,
    extend_path,
    learn_storey,
)
LOCATE = (
    find_floor,
    extend_trails,
    keep_in_path,
    apply_reported_place,
    show,
    note_inside,
)
LOCATE_LATE = (find_earlier_floor, insert_into_trails)


class Positioning:
    """Fusers of all units with the map that they use; all else is in the live state."""

    def __init__(
        self,
        kind: FuserKind,
        smoother: Smoother,
        plans: PlanReader,
        saved: Mapping[str, bytes],
        saved_pinned: Mapping[str, bytes],
    ) -> None:
        self._plans = plans
        self._fusers = UnitFusers(kind, smoother, saved, saved_pinned)
        self._lost_contact: dict[str, LostContact] = {}  # by site

    @property
    def fuser(self) -> str:
        """Name of the fuser of all units."""
        return self._fusers.kind.name

    def save(self) -> tuple[dict[str, bytes], dict[str, bytes]]:
        """Saved states of the fusers: of those that ignore pins, and of those that follow them."""
        return self._fusers.save(), self._fusers.pinned.save()

    # ---- a position

    def fuse(self, state: StationState, unit: UnitState, position: Position) -> list[Output]:
        """Update the estimate with a position, and show the result."""
        fusers, history = self._fusers.of(unit), state.path_of(unit.unit_id)
        has_plan = self._fusers.grids.get(unit.site_id) is not None
        site = state.sites[unit.site_id]
        update = PositionUpdate(state, site, unit, position, history, fusers, has_plan)
        for stage in FUSE:
            stage(update)
        if history.is_awaited or (update.begins_path and has_pins(state, unit.unit_id)):
            return self.solve_pins(state, [unit.unit_id])
        return self._locate(state, unit, fusers, update.boot)

    def locate(self, state: StationState, unit: UnitState) -> list[Output]:
        """Show the present estimate of a unit's fusers."""
        return self._locate(state, unit, self._fusers.of(unit), None)

    def _locate(
        self,
        state: StationState,
        unit: UnitState,
        fusers: tuple[Fuser, ...],
        boot: BootState | None,
    ) -> list[Output]:
        """``boot``: of the unit's path, where the caller knows it."""
        header, estimate, pinned = state.next_header(), fusers[0].estimate(), None
        if estimate is None:
            return []
        if len(fusers) > 1:
            pinned = fusers[1].estimate() or estimate
        boot = boot or unit.path_boot
        history, name = state.paths.get(unit.unit_id), self._fusers.kind.name
        update = LocationUpdate(state, unit, history, boot, name, header, estimate, pinned)
        for stage in LOCATE:
            stage(update)
        return [update.fused]

    def fuse_late(self, state: StationState, unit: UnitState, position: Position) -> list[Output]:
        """Insert a late position into path and trail; one for each second, as trails and database
        keep them.
        """
        header = state.next_header()
        boot, running = unit.path_boot_of(position), unit.path_boot
        if boot is None or not boot.is_placed:
            return []
        t_ns = boot.station_ns(position.header.t_mono_ns)
        if t_ns < unit.site_ns:
            unit.count_rejected(BEFORE_SITE)
            return []
        if boot is not running and t_ns >= running.first_live_ns:
            return []  # another machine under the same name
        for fuser in self._fusers.of(unit):
            fuser.insert_late_position(position)
        second = t_ns // NS_PER_S
        if second == unit.place.last_backfill_s:
            return []
        estimate, *others = [one.estimate_at(position) for one in self._fusers.of(unit)]
        if estimate is None:
            return []
        unit.place.last_backfill_s = second
        pinned = others[0] if others else None
        history, name = state.paths.get(unit.unit_id), self._fusers.kind.name
        update = LocationUpdate(state, unit, history, boot, name, header, estimate, pinned)
        for stage in LOCATE_LATE:
            stage(update)
        if history is not None:
            history.insert_late(position, update.plain.t_meas_ns, estimate, update.plain.floor)
        resolve_later(state, unit.unit_id)
        return [update.fused, TrailBackfilled(unit.unit_id)]

    def apply_fix(self, state: StationState, unit: UnitState, fix: GpsFix) -> list[Output]:
        """Update the estimate with a satellite fix, and show the result."""
        is_used = apply_fix(state, self._fusers, unit, fix).accepted
        return self.locate(state, unit) if is_used else []

    def solve_pins(self, state: StationState, unit_ids: Collection[str]) -> list[Output]:
        """Solve the paths of these units again, and show the results, also of members without
        contact.
        """
        solved = solve_pins(state, self._fusers, unit_ids)
        outputs: list[Output] = [PinsChanged(tuple(sorted(solved)))]
        for unit_id, is_redrawn in sorted(solved.items()):
            outputs += [*self.locate(state, state.units[unit_id]), UnitChanged(unit_id)]
            if is_redrawn:
                outputs.append(TrailBackfilled(unit_id))
        return outputs

    def renumber_next_trail(self, state: StationState) -> list[Output]:
        """Renumber the floors of the next trail that waits for it."""
        unit_id = renumber_next_trail(state)
        return [] if unit_id is None else [TrailBackfilled(unit_id)]

    def reach(self, state: StationState, unit: UnitState) -> Ring:
        """``LostContact.reach`` of now."""
        return self._lost_contact[unit.site_id].reach(state.t_ns, unit)

    # ---- frame, map and incident

    def set_map(self, state: StationState, site_id: str) -> None:
        """Use the walls of a site's plan in the fusers of its units."""
        grid = self._plans.grid(state.sites[site_id].placed_plan)
        self._fusers.set_map(site_id, grid, state.units_on(site_id))
        self._lost_contact[site_id] = LostContact(grid)

    def replace_map(self, state: StationState, site_id: str) -> None:
        """Use another plan; its floors may have other numbers."""
        self.set_map(state, site_id)
        renumber(state, site_id)

    def use_fuser(self, state: StationState, name: str) -> set[str]:
        """Use another fuser for all units, from their present estimates; returns the units whose
        paths must be solved again.  UserError where there is no such fuser.
        """
        kind = fuser_named(name)
        if kind is None:
            raise UserError(
                coded("fuser-unknown", "this version of Muster has no fuser '{fuser}'", fuser=name)
            )
        state.fuser = name
        self._fusers.use_kind(kind, state)
        return {
            one
            for site in state.sites.values()
            for pin in site.pins.values()
            for one in units_of(pin)
        }

    def begin_incident(self, state: StationState, site_id: str, before_ns: int) -> set[str]:
        """Drop paths and pins of a site before that time; returns the units whose paths change by
        it.
        """
        site = state.sites[site_id]
        site.learnt_floors.trim(before_ns)
        site.learnt_building = LearntBuilding()
        for history in state.paths_on(site_id).values():
            history.begin_incident(state.t_ns, before_ns)
        for unit in state.units_on(site_id):
            if unit.trails.unpinned is not None:
                unit.trails.unpinned.clear()
        kept = set().union(*map(units_of, site.pins.values()))
        return kept | drop(site, lambda pin: is_about(pin, before_ns))

    def start(self, state: StationState, unit: UnitState, start: Start) -> None:
        """Set the start of a unit's path, in the plan's frame where there is one
        (``switch_to_plan_frame``).
        """
        site = state.sites[unit.site_id]
        site.start_set = True
        if unit.unit_id == site.barometers.reference_id:
            site.common_mode_error = CommonModeError()
        history = state.path_of(unit.unit_id)
        if history.is_before_incident and unit.link != "live":  # of the run that is to come
            self._fusers.forget(unit)
            history = state.paths[unit.unit_id] = history.for_next_boot()
            drop_learnt(state, unit.unit_id)
        begin(state, unit, self._fusers.plain(unit), history, start)

    def switch_to_plan_frame(self, state: StationState, site_id: str) -> set[str]:
        """Make the plan's frame the incident frame of a site, at the first place that a person
        gives on the plan: estimates from satellites do not hold in it. Returns the units whose
        paths change.
        """
        site, paths = state.sites[site_id], state.paths_on(site_id)
        site.anchor, site.anchor_by_gps, site.common_mode_error = None, False, CommonModeError()
        self.set_map(state, site_id)
        for unit_id, history in paths.items():
            unit = state.units[unit_id]
            before = self._fusers.forget(unit)
            history.drop_fixes()
            drop_learnt(state, unit_id)
            unit.trails.replace_plain(0, [])
            if unit.position is None:
                unit.place.fused = None
                continue
            self._fusers.plain(unit).predict(unit.position)
            was = None if before is None else before.estimate()
            replay_from_start(state, unit, self._fusers.plain(unit), history, was)
        return set(paths)

    def move(self, state: StationState, unit: UnitState, site_id: str) -> set[str]:
        """Move a unit to another site; its path begins anew in that frame.  Returns the units whose
        pins concerned its path.
        """
        partners = drop(state.sites[unit.site_id], lambda pin: unit.unit_id in units_of(pin))
        self._fusers.forget(unit)
        state.paths.pop(unit.unit_id, None)
        drop_learnt(state, unit.unit_id)
        state.late.pop(unit.unit_id, None)
        unit.place = UnitPlace()
        unit.trails.replace_plain(0, [])
        unit.site_id, unit.site_ns = site_id, state.t_ns
        return partners - {unit.unit_id}

    def keep_sites(self, state: StationState) -> None:
        """Drop sites that have neither units nor an incident."""
        used = {OWN_SITE_ID, *(unit.site_id for unit in state.units.values())}
        used |= {incident.site_id for incident in state.incidents.values()}
        for site_id in state.sites.keys() - used:
            del state.sites[site_id]
            self._fusers.grids.pop(site_id, None)
            self._lost_contact.pop(site_id, None)

    def forget(self, state: StationState, unit: UnitState) -> None:
        """Delete a unit's paths and the landmarks learnt from them."""
        self._fusers.forget(unit)
        state.paths.pop(unit.unit_id, None)
        site = state.sites[unit.site_id]
        site.learnt_floors.forget(unit.unit_id)
        site.learnt_building = site.learnt_building.without(unit.unit_id)
        state.late.pop(unit.unit_id, None)
        unit.place.fused, unit.position = None, None
        unit.trails.shown.clear()

    def set_anchor(self, state: StationState, site_id: str, anchor: Anchor) -> None:
        """Set the anchor of a site. Places set by hand stay on the plan; a frame that the first fix
        had defined moves with the new anchor, unless that fix was far off.
        """
        site = state.sites[site_id]
        old = site.anchor
        if old is not None and old != anchor:
            move = moved_by(anchor, old, site.fixes_anchor)
            if site.anchor_by_gps and math.hypot(move.north_m, move.east_m) <= MAX_FIX_DISTANCE_M:
                for fuser in self._fusers.existing(state.units_on(site_id)):
                    fuser.reframe(move.turn_rad, move.north_m, move.east_m, move.down_m)
                reframe(state, site_id, move)
            else:
                move_fixes(state, site_id, move.turn_rad, move.north_m, move.east_m)
        site.anchor, site.anchor_by_gps, site.common_mode_error = anchor, False, CommonModeError()
        self.set_map(state, site_id)
