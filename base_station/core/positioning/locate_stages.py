"""Stages of an estimate on its way to the consoles (``positioning.LOCATE``).

The estimate of a late position passes ``positioning.LATE``: it changes trail and path, but not the
present position.
"""

from __future__ import annotations

from typing import Any

import msgspec

from base_station.core.positioning import building_entry, reported_place
from base_station.core.positioning.fused_message import fused_message
from base_station.core.state import StationState, UnitState
from base_station.core.state.boot_state import BootState
from base_station.fusion.interface import Estimate
from base_station.fusion.odometry.path_history import PathHistory
from shared.messages import FusedPosition, Header

_LATER: Any = None  # set by a stage, and read by none before it


class LocationUpdate(msgspec.Struct, gc=False):
    """Estimate of a unit; a stage reads the fields that earlier stages have set."""

    state: StationState
    unit: UnitState
    history: PathHistory | None
    boot: BootState  # its clock dates the estimate
    fuser: str  # name of its kind
    header: Header  # of the message
    estimate: Estimate  # without pins
    pinned: Estimate | None  # None: no pin of the unit is in use
    plain: FusedPosition = _LATER  # without pins
    fused: FusedPosition = _LATER


def find_floor(update: LocationUpdate) -> None:
    """Find the floor, without pins and with them; it changes only well beyond its border."""
    fused, history = update.unit.place.fused, update.history
    held = None if fused is None else fused.floor
    _make_messages(update, held if history is None else history.latest.floor, held)


def find_earlier_floor(update: LocationUpdate) -> None:
    """Find the floor at an earlier time, where the floor before it is unknown."""
    _make_messages(update, None, None)


def extend_trails(update: LocationUpdate) -> None:
    """Add the newest point of the trails, within the shown incident."""
    if _is_drawn(update):
        update.unit.trails.extend(update.plain, update.fused)


def insert_into_trails(update: LocationUpdate) -> None:
    """Add an earlier point of the trails, within the shown incident."""
    if _is_drawn(update):
        update.unit.trails.insert(update.plain, update.fused)


def keep_in_path(update: LocationUpdate) -> None:
    """Keep the estimate without pins at the newest point of the path."""
    if update.history is not None:
        update.history.set_live_estimate(update.estimate, update.plain.floor)


def apply_reported_place(update: LocationUpdate) -> None:
    """Prefer a person's pin that is newer than the path."""
    if update.history is not None:
        update.fused = reported_place.apply_reported_place(
            update.state, update.history, update.fused
        )


def show(update: LocationUpdate) -> None:
    """Store the estimate as the unit's position in the live state."""
    update.unit.place.show(update.fused, update.state.t_ns)


def note_inside(update: LocationUpdate) -> None:
    """Note the time since which the wearer is in the building."""
    building_entry.note_inside(update.state, update.unit)


def _make_messages(update: LocationUpdate, held_without_pins: int | None, held: int | None) -> None:
    state, unit, boot, header = update.state, update.unit, update.boot, update.header
    update.plain = update.fused = fused_message(
        state, unit, boot, update.estimate, update.fuser, held_without_pins, header
    )
    if update.pinned is not None:
        update.fused = fused_message(state, unit, boot, update.pinned, update.fuser, held, header)


def _is_drawn(update: LocationUpdate) -> bool:
    incident = update.state.incident_of(update.unit)
    return incident is None or update.plain.t_meas_ns >= incident.opened_ns
