"""Orders of an incident, and their outcome at each unit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import msgspec

from base_station.report.contents import OrderEntry, OrderReceipt
from base_station.report.log_facts import LogFacts, ReplyRecord
from base_station.storage.db.models import AuditEntry
from shared.messages import CommandKind, CommandState
from shared.messages.station import ConfirmCommand, SendCommand, UndoConfirmation

ASKED_PAR = CommandKind.PAR_REQUEST.name
_STOPPED = CommandKind.END_ORDER.name  # a LOCATE: the timeline has it
_UNKNOWN = CommandKind.UNKNOWN.name


def orders_of(entries: Sequence[AuditEntry], facts: LogFacts) -> tuple[OrderEntry, ...]:
    """Orders from the ``entries`` of the audit, which are oldest first."""
    replies: dict[tuple[str, str], list[ReplyRecord]] = {}
    for reply in facts.replies:
        replies.setdefault((reply.command_id, reply.unit_id), []).append(reply)
    by_radio = _confirmed_by_radio(entries)
    repeat_ids = _repeat_ids(entries)
    found = []
    for entry in entries:
        sent = details_of(entry) if entry.action == SendCommand.__name__ else None
        if not sent:
            continue
        command_id = str(sent["command_id"])
        ids = (command_id, *repeat_ids.get(command_id, ()))
        units = sorted({unit_id for one in ids for unit_id in facts.commands.get(one, {})})
        receipts = tuple(
            _receipt(
                unit_id,
                [reply for one in ids for reply in replies.get((one, unit_id), ())],
                by_radio.get((command_id, unit_id)),
            )
            for unit_id in units
        )
        kind, is_repeat = kind_name(sent["kind"]), bool(sent.get("repeats"))
        if kind != _STOPPED:
            found.append(OrderEntry(entry.t_ns, entry.by, kind, sent["text"], receipts, is_repeat))
    return tuple(found)


def _repeat_ids(entries: Sequence[AuditEntry]) -> Mapping[str, list[str]]:
    """Ids under which each order was sent again."""
    found: dict[str, list[str]] = {}
    for entry in entries:
        sent = details_of(entry) if entry.action == SendCommand.__name__ else {}
        if sent.get("repeats"):
            found.setdefault(str(sent["repeats"]), []).append(str(sent["command_id"]))
    return found


def details_of(entry: AuditEntry) -> Mapping[str, Any]:
    """Fields of the action of an audit entry; empty if they were erased."""
    try:
        details: Mapping[str, Any] = msgspec.json.decode(entry.detail, type=dict[str, Any])
    except msgspec.DecodeError:
        return {}
    return details


def kind_name(kind: int) -> str:
    """Name of a kind of command; one of a newer program has none."""
    return CommandKind(kind).name if kind in set(CommandKind) else _UNKNOWN


def _receipt(
    unit_id: str, replies: Iterable[ReplyRecord], by_radio: tuple[int, str] | None
) -> OrderReceipt:
    times: dict[CommandState, int] = {}
    refused = None
    for reply in replies:
        times[reply.state] = min(times.get(reply.state, reply.t_ns), reply.t_ns)
        if reply.state is CommandState.REFUSED:
            refused = reply.detail
    radio_ns, radio_by = by_radio or (None, "")
    return OrderReceipt(
        unit_id,
        received_ns=min(times.values(), default=None),
        acknowledged_ns=times.get(CommandState.ACKNOWLEDGED),
        radio_ns=radio_ns,
        radio_by=radio_by,
        refused=refused,
    )


def _confirmed_by_radio(entries: Iterable[AuditEntry]) -> dict[tuple[str, str], tuple[int, str]]:
    """Time and user of each confirmation, by command and unit; those undone are left out."""
    confirmed: dict[tuple[str, str], tuple[int, str]] = {}
    for entry in entries:
        details = details_of(entry)
        if details and entry.action == ConfirmCommand.__name__:
            confirmed.setdefault(
                (details["command_id"], details["unit_id"]), (entry.t_ns, entry.by)
            )
        elif details and entry.action == UndoConfirmation.__name__:
            undone = [
                one
                for one in confirmed
                if one[0] == details["entry_id"] and details["unit_id"] in ("", one[1])
            ]
            for one in undone:
                del confirmed[one]
    return confirmed
