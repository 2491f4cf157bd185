"""Order of an erasure in the log that two stations share, and the part of the log before it.  Pure.

Each station rewrites its own log, at its own time.  Both rewrite the same records, because the
order is an event in the log: events before it are redacted, and events behind it stay as they are.
Derived records are not shared between the stations, and are redacted to the end of the log.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from base_station.core.erasure.erasure import Record, actions_of
from base_station.core.log_position import is_event
from shared.channels import OPERATOR
from shared.messages import STATION_ID
from shared.messages.station import BeginErasure

_ACTIONS = OPERATOR.key(STATION_ID)


class ErasureOrder(NamedTuple):
    """Record ``BeginErasure`` of a log."""

    action_id: str
    t_ns: int
    by: str


def orders_of(records: Iterable[Record]) -> Iterable[tuple[ErasureOrder, BeginErasure]]:
    """Yield the orders among records, with their subjects."""
    for t_ns, done in actions_of(records):
        if isinstance(done.action, BeginErasure):
            yield ErasureOrder(done.action_id, t_ns, done.by), done.action


def last_order(actions: Iterable[Record], kind: str, subject_id: str) -> ErasureOrder | None:
    """The last order to erase this subject among an operator's actions of a log."""
    wanted = BeginErasure(kind, subject_id)
    return next((order for order, one in reversed([*orders_of(actions)]) if one == wanted), None)


def actions_before(actions: Sequence[Record], order: ErasureOrder | None) -> Sequence[Record]:
    """Operators' actions before the order; all of them where there is none."""
    if order is None:
        return actions
    before: list[Record] = []
    for record in actions:
        if _is_order(record, order):
            break
        before.append(record)
    return before


class OrderedPart:
    """Records of a log up to an order, one by one; without an order the whole log."""

    def __init__(self, order: ErasureOrder | None) -> None:
        self._order = order
        self._is_behind = False

    def redacted(self, record: Record, redactor: Callable[[Record], list[Record]]) -> list[Record]:
        """Return the records that replace it; an event behind the order stays."""
        if self._is_behind and is_event(record[1]):
            return [record]
        if self._order is not None and _is_order(record, self._order):
            self._is_behind = True
        return redactor(record)


def _is_order(record: Record, order: ErasureOrder) -> bool:
    if record[0] != order.t_ns or record[1] != _ACTIONS:
        return False
    return any(one.action_id == order.action_id for _, one in actions_of((record,)))
