"""Idempotency: a request that its client repeats is done once.

The id of such an action contains the client's key and a digest of the request.  So the log
shows finished requests, to every reader of the log: the station after a restart, and a standby that
takes over.
"""

from __future__ import annotations

import re
from hashlib import sha256

import msgspec

from base_station.core.state import ERASED_TEXT, IdempotencyRecord, StationState
from shared.coded_text import NO_CODE, code_of_text
from shared.messages import OperatorAction
from shared.messages.pins import SetMeeting, SetPin, StartTogether
from shared.messages.station import Action, OpenIncident, SendCommand

KEPT = 1000  # requests; a client without an answer repeats its request within minutes
KEY_DIGITS = 16  # of a row's id
_DIGEST = "[0-9a-f]{32}"
_ACTION_ID = re.compile(rf"({_DIGEST})\.({_DIGEST})\.{_DIGEST}")


def idempotent_action_id(by: str, key: str, request: bytes, own: str) -> str:
    """Return the id of an action, which begins with digests of person and key, and of the request.
    ``own``: 32 hexadecimal digits that differ for every action, so that an id is unique even with
    an old key.
    """
    return f"{_digest(f'{by} {key}'.encode())}.{_keyed_digest(by, key, request)}.{own}"


def row_id(by: str, key: str, request: bytes) -> str:
    """Return the id of a row that is no action: its first ``KEY_DIGITS`` are those of the key."""
    of_key = _digest(f"{by} {key}".encode())
    return of_key[:KEY_DIGITS] + _keyed_digest(by, key, request)[:KEY_DIGITS]


def audit_entry_prefixes(by: str, key: str) -> tuple[str, str]:
    """Return the prefixes of audit entry ids of a user's key: of an action, and of a row."""
    digest = _digest(f"{by} {key}".encode())
    return f"{digest}.", f"added-{digest[:KEY_DIGITS]}"


def is_same_request(action_id: str, before: str) -> bool:
    """True where two actions with one key are one request, or there is no key."""
    return not _key_of(action_id) or action_id.rpartition(".")[0] == before.rpartition(".")[0]


def earlier_result(state: StationState, action_id: str) -> IdempotencyRecord | None:
    """Result of the earlier request with this action's key; None where there is none."""
    return state.idempotency_records.get(_key_of(action_id))


def record_result(state: StationState, done: OperatorAction, refused: str) -> None:
    """``refused``: why it had no effect; empty: it had."""
    key = _key_of(done.action_id)
    if not key:
        return
    while len(state.idempotency_records) >= KEPT:
        del state.idempotency_records[next(iter(state.idempotency_records))]
    created_id = created_id_of(done.action)
    state.idempotency_records[key] = IdempotencyRecord(
        done.action_id, state.t_ns, created_id, str(refused), code_of_text(refused)
    )


def erase_reasons(state: StationState) -> None:
    """Erase the reasons of refusals, which may contain names."""
    for key, done in state.idempotency_records.items():
        if done.refused:
            state.idempotency_records[key] = msgspec.structs.replace(
                done, refused=ERASED_TEXT, refused_code=NO_CODE
            )


def created_id_of(action: Action) -> str:
    """Id of the object that the action creates; empty where it creates none."""
    match action:
        case SendCommand(command_id=created_id) | OpenIncident(incident_id=created_id):
            return created_id
        case (
            SetPin(pin_id=created_id)
            | SetMeeting(pin_id=created_id)
            | StartTogether(pin_id=created_id)
        ):
            return created_id
        case _:
            return ""


def _key_of(action_id: str) -> str:
    """Return the key in an action's id; empty: it came without one."""
    telling = _ACTION_ID.fullmatch(action_id)
    return "" if telling is None else telling[1]


def _keyed_digest(by: str, key: str, request: bytes) -> str:
    """Digest of a request, which may be a name, for the log: without the key it is not found by
    trying names.
    """
    return _digest(f"{by} {key} ".encode() + request)


def _digest(content: bytes) -> str:
    return sha256(content).hexdigest()[:32]
