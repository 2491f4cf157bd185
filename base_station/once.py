"""What a client may have to ask for again is done once.

The id of such an action tells the client's key and what was asked.  So the log knows what was done
already, and with it whoever reads that: the station after a restart, and a standby that takes over.
"""

from __future__ import annotations

import re
from hashlib import sha256

import msgspec

from base_station.live_state import FORGOTTEN, DoneOnce, StationState
from shared.messages import OperatorAction
from shared.messages.pins import SetMeeting, SetPin, StartTogether
from shared.messages.station import Action, OpenIncident, SendCommand

KEPT = 1000  # requests; whoever has had no answer asks again within minutes
KEY_DIGITS = 16  # of a row's id
_DIGEST = "[0-9a-f]{32}"
_ACTION_ID = re.compile(rf"({_DIGEST})\.({_DIGEST})\.{_DIGEST}")


def once_id(by: str, key: str, asked: bytes, own: str) -> str:
    """For an action: with the same key, the same person asks for the same thing again.  ``own``:
    32 hexadecimal digits, other ones for every action, however old a key is that comes again.
    """
    return f"{_digest(f'{by} {key}'.encode())}.{_digest(asked)}.{own}"


def row_id(by: str, key: str, asked: bytes) -> str:
    """For what is added to a table and is no action: its first ``KEY_DIGITS`` tell the key."""
    return _digest(f"{by} {key}".encode())[:KEY_DIGITS] + _digest(asked)[:KEY_DIGITS]


def asks_the_same(action_id: str, before: str) -> bool:
    """Whether two actions with one key are one request; without a key nothing was before."""
    return not _key_of(action_id) or action_id.rpartition(".")[0] == before.rpartition(".")[0]


def done_before(state: StationState, action_id: str) -> DoneOnce | None:
    """What was done with this action's key; None: nothing is known of that."""
    return state.done_once.get(_key_of(action_id))


def note_done(state: StationState, done: OperatorAction, refused: str) -> None:
    """``refused``: why it had no effect; empty: it had."""
    key = _key_of(done.action_id)
    if not key:
        return
    while len(state.done_once) >= KEPT:
        del state.done_once[next(iter(state.done_once))]
    made_id = made_by(done.action)
    state.done_once[key] = DoneOnce(done.action_id, state.t_ns, made_id, refused)


def forget_words(state: StationState) -> None:
    """Why something was refused may name somebody."""
    for key, done in state.done_once.items():
        if done.refused:
            state.done_once[key] = msgspec.structs.replace(done, refused=FORGOTTEN)


def made_by(action: Action) -> str:
    """The id of what it makes; empty: it makes nothing that has one."""
    match action:
        case SendCommand(command_id=made_id) | OpenIncident(incident_id=made_id):
            return made_id
        case SetPin(pin_id=made_id) | SetMeeting(pin_id=made_id) | StartTogether(pin_id=made_id):
            return made_id
        case _:
            return ""


def _key_of(action_id: str) -> str:
    """Empty: the action came without a key."""
    telling = _ACTION_ID.fullmatch(action_id)
    return "" if telling is None else telling[1]


def _digest(said: bytes) -> str:
    return sha256(said).hexdigest()[:32]
