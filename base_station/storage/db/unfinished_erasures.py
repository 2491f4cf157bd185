"""Erasures that another station of a pair ordered in the log and never reported as done, as when it
is lost for good in the middle of one.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import msgspec
from sqlalchemy import select

from base_station.storage.db.database import Database
from base_station.storage.db.erasure import FORGOT_INCIDENT, FORGOT_PERSON
from base_station.storage.db.models import AuditEntry
from shared.messages.station import BeginErasure, TakeOver

_ORDER, _TAKE_OVER = BeginErasure.__name__, TakeOver.__name__
_DONE = FORGOT_PERSON, FORGOT_INCIDENT


class UnfinishedErasure(NamedTuple):
    """Order without a report; its subject as "person ID" or "incident ID"."""

    order_id: str
    subject: str


class UnfinishedErasures:
    """Read from the audit, each entry once; for one thread."""

    def __init__(self, store: Database) -> None:
        self._store = store
        self._number = 0  # of the last entry that was read
        self._ordered: dict[str, str] = {}  # id of the order by subject
        self._is_of_pair = False  # the log was
        self._left: dict[str, str] = {}  # of them, those from before the last take-over

    def find_orphaned(self) -> tuple[UnfinishedErasure, ...]:
        """Those of a log that two stations have shared, for one that runs alone now: all of them,
        as no take-over is behind the last ones.  Raises StoreError.
        """
        self._read()
        return self._named(self._ordered) if self._is_of_pair else ()

    def find(self) -> tuple[UnfinishedErasure, ...]:
        """Erasures ordered before the last take-over: the station that leads has later ones in its
        queue.  Raises StoreError.
        """
        self._read()
        return self._named(self._left)

    def _read(self) -> None:
        """The entries that are new."""
        wanted = (
            select(AuditEntry)
            .where(AuditEntry.number > self._number)
            .where(AuditEntry.action.in_((_ORDER, _TAKE_OVER, *_DONE)))
            .order_by(AuditEntry.number)
        )
        with self._store.read() as session:
            for entry in session.scalars(wanted):
                self._take(entry)

    @staticmethod
    def _named(orders: Mapping[str, str]) -> tuple[UnfinishedErasure, ...]:
        return tuple(UnfinishedErasure(one, subject) for subject, one in orders.items())

    def _take(self, entry: AuditEntry) -> None:
        self._number = entry.number
        if entry.action == _TAKE_OVER:
            self._is_of_pair = True
            self._left = dict(self._ordered)
        elif entry.action == _ORDER:
            order = msgspec.json.decode(entry.detail, type=BeginErasure)
            self._ordered[f"{order.kind} {order.subject_id}"] = entry.entry_id
        else:
            subject = entry.detail.partition(":")[0]
            self._ordered.pop(subject, None)
            self._left.pop(subject, None)
