"""Erasures in the part of a log that is cut off where two stations parted.

An erasure rewrites the records before its order, which the leader's log has as they were if it
never got the order.  Each record is erased by what stands before it, so nothing differs once the
leader has erased the same; only an incident that is still open in the leader's log must be the same
at both meanwhile: people are in it, and it is erased when it is closed.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from base_station.core.erasure.erasure import actions_of
from base_station.core.log_position import START, LogPosition, events_after
from base_station.core.people_actions import PeopleAction, apply_people_action
from base_station.core.state import StationState
from shared.channels import OPERATOR
from shared.errors import UserError
from shared.mcap_log import read_log
from shared.messages import STATION_ID, OperatorAction
from shared.messages.station import BeginErasure, ForgetWearers

_ACTIONS = OPERATOR.key(STATION_ID)


def orders_behind(log: Path, place: LogPosition) -> list[tuple[str, BeginErasure]]:
    """Orders to erase behind a place, each with who gave it."""
    return [
        (done.by, done.action)
        for done in _actions_behind(log, place)
        if isinstance(done.action, BeginErasure)
    ]


def kept_until(log: Path, place: LogPosition) -> LogPosition:
    """Place up to which a log that is cut at ``place`` is the leader's: before the opening of an
    incident that is open there, where an erasure that is cut off may have rewritten it.
    """
    behind = _actions_behind(log, place)
    if not any(isinstance(one.action, BeginErasure | ForgetWearers) for one in behind):
        return place
    behind_ids = {one.action_id for one in behind}
    state = StationState()
    for t_ns, done in actions_of(read_log(log, end_ns=place.t_ns + 1, keys={_ACTIONS})):
        if isinstance(done.action, PeopleAction) and done.action_id not in behind_ids:
            state.t_ns = t_ns
            with suppress(UserError):  # it was refused then, too
                list(apply_people_action(state, done.by, done.action))
    if not state.open_incidents:
        return place
    kept = START
    for t_ns, _, _ in events_after(START, read_log(log, end_ns=state.open_incidents[0].opened_ns)):
        kept = kept.next(t_ns)
    return kept


def _actions_behind(log: Path, place: LogPosition) -> list[OperatorAction]:
    return [done for _, done in actions_of(events_after(place, read_log(log, place.t_ns)))]
