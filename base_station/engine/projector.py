"""Projector: makes rows of the database from the pipeline's outputs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import msgspec

from base_station.core.events import (
    ClosedIncidentChanged,
    IncidentOpened,
    MembershipChanged,
    Output,
    Received,
    Refused,
    StationEvent,
)
from base_station.storage.projection import Projection
from shared.channels import tracked_unit
from shared.clock import NS_PER_S
from shared.messages import STATION_ID, AlarmChange, FusedPosition, OperatorAction, UnitDescription

LAST_MESSAGE_STEP_NS = 5 * NS_PER_S  # the times of units' last messages are stored in such steps


class Projector:
    """Collector of outputs, whose projection ``take`` returns."""

    def __init__(self) -> None:
        self._alarms: list[AlarmChange] = []
        self._tracks: list[FusedPosition] = []
        self._actions: list[OperatorAction] = []
        self._descriptions: list[UnitDescription] = []
        self._last_messages: dict[str, int] = {}
        self._news: dict[str, None] = {}  # incidents; an ordered set
        self._opened: list[tuple[str, str]] = []
        self._memberships: list[tuple[str, str, int]] = []
        self._projected: dict[str, int] = {}
        self._track_second: dict[str, int] = {}  # by unit, of its newest track point
        self._collectors: dict[type[Output], Callable[[Any], None]] = {
            AlarmChange: self._alarms.append,
            FusedPosition: self._note_track,
            ClosedIncidentChanged: self._note_news,
            IncidentOpened: lambda one: self._opened.append(msgspec.structs.astuple(one)),
            MembershipChanged: lambda one: self._memberships.append(msgspec.structs.astuple(one)),
        }

    def note(self, event: StationEvent, outputs: Sequence[Output]) -> None:
        for output in outputs:
            collect = self._collectors.get(type(output))
            if collect is not None:
                collect(output)
        if not isinstance(event, Received):
            return
        message = event.message
        if type(message) is OperatorAction:
            if not any(isinstance(output, Refused) for output in outputs):
                self._actions.append(_at_station_time(message, event.t_ns))
        elif outputs and message.header.unit_id != STATION_ID and not tracked_unit(event.unit_id):
            self._note_message(event.unit_id, event.t_ns)
            if type(message) is UnitDescription:
                self._descriptions.append(message)

    @property
    def is_urgent(self) -> bool:
        """True if it has more than positions and times of last messages."""
        return bool(self._alarms or self._actions or self._descriptions)

    def take(self, t_ns: int) -> Projection | None:
        """Return the projection of the collected outputs; None if nothing changed."""
        parts = (
            self._alarms,
            self._tracks,
            self._actions,
            self._descriptions,
            self._last_messages,
            self._news,
            self._opened,
            self._memberships,
        )
        if not any(parts):
            return None
        projection = Projection(
            t_ns=t_ns,
            alarms=tuple(self._alarms),
            tracks=tuple(self._tracks),
            actions=tuple(self._actions),
            descriptions=tuple(self._descriptions),
            last_messages=tuple(self._last_messages.items()),
            news=tuple(self._news),
            opened=tuple(self._opened),
            memberships=tuple(self._memberships),
        )
        for part in parts:
            part.clear()
        return projection

    def _note_message(self, unit_id: str, t_ns: int) -> None:
        if t_ns - self._projected.get(unit_id, 0) >= LAST_MESSAGE_STEP_NS:
            self._projected[unit_id] = self._last_messages[unit_id] = t_ns

    def _note_news(self, changed: ClosedIncidentChanged) -> None:
        self._news[changed.incident_id] = None

    def _note_track(self, fused: FusedPosition) -> None:
        second = fused.t_meas_ns // NS_PER_S
        if self._track_second.get(fused.unit_id) != second:
            self._track_second[fused.unit_id] = second
            self._tracks.append(fused)


def _at_station_time(action: OperatorAction, t_ns: int) -> OperatorAction:
    """Give each action its own time, as a projection may have actions of different times."""
    header = msgspec.structs.replace(action.header, t_utc_ns=t_ns)
    return msgspec.structs.replace(action, header=header)
