"""Alarms with every change in their lives, as the API answers them."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from base_station.storage.db.models import AlarmRow, AlarmTransition
from base_station.storage.db.roster import Roster
from base_station.views.alarm_parameters import stored_parameters_view
from base_station.views.answer import Answer, to_ms
from base_station.views.station import alarm_view
from base_station.views.wire import AlarmParametersView, AlarmView


class AlarmHistoryEntry(Answer, frozen=True):
    """One change in the life of an alarm."""

    t_ms: int
    state: str
    level: str
    text: str
    by: str
    code: str
    parameters: AlarmParametersView
    reason: str  # as in ``AlarmView``
    note: str
    peak: float | None


class AlarmWithLife(AlarmView, frozen=True, kw_only=True):
    changes: tuple[AlarmHistoryEntry, ...]  # oldest first


def with_life(alarm: AlarmRow, changes: Iterable[AlarmTransition], roster: Roster) -> AlarmWithLife:
    """Answer about an alarm of the tables, with its changes in time order and with the names of
    people.
    """
    view = alarm_view(alarm, roster.known)
    entries = tuple(
        AlarmHistoryEntry(
            to_ms(one.t_ns),
            one.state,
            one.level,
            roster.shown(one.text),
            roster.shown(one.by),
            one.code,
            stored_parameters_view(one.parameters, roster.known),
            one.reason,
            roster.shown(one.note),
            one.peak,
        )
        for one in changes
    )
    return AlarmWithLife(**msgspec.structs.asdict(view), changes=entries)
