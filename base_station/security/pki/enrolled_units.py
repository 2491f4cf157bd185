"""Registration of enrolled units, which need not be registered by hand as well.  The
audit has all that was issued and revoked, by every user, also while no station ran.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Collection, Iterator

from base_station.engine.ports import OperatorGate
from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.registry import Entry, Registry
from base_station.storage.db.records import Records
from shared.enrolment import Holder
from shared.log_on_change import LogOnChange
from shared.messages import STATION_ID
from shared.messages.station import RegisterUnit

_log = logging.getLogger(__name__)


_BY_COMMAND = "muster pki"  # in the audit


class EnrolledUnits:
    """Registers enrolled units with the live station, each once."""

    def __init__(
        self,
        pki: PkiFolder,
        gate: OperatorGate,
        registered: Callable[[], Collection[str]],
        records: Records,
    ) -> None:
        """``registered`` gives the ids of units that are registered already."""
        self._pki = pki
        self._gate = gate
        self._registered = registered
        self._records = records
        self._trouble = LogOnChange(_log, "who is enrolled could not be taken up")
        self._done: set[str] = set()
        self._audited: set[str] = set()

    def update(self) -> None:
        """Read enrolments again, where there is an authority; a file that cannot be read waits."""
        if not self._pki.exists():
            return
        with self._trouble:
            registry = self._pki.registry()
            self._register_new(registry)
            self._audit_new(registry)

    def _register_new(self, registry: Registry) -> None:
        enrolled = {
            entry.name
            for entry in registry.entries
            if entry.holder is Holder.UNIT and entry.revoked is None
        }
        if new := enrolled - self._done:
            for unit_id in sorted(new.difference(self._registered())):
                self._gate.submit(STATION_ID, RegisterUnit(unit_id, ""))
            self._done |= new

    def _audit_new(self, registry: Registry) -> None:
        """An entry's id is the certificate's, so that each of two stations adds it once."""
        done = {
            entry_id: text
            for entry in registry.entries
            for entry_id, text in _audit_text(entry)
            if entry_id not in self._audited
        }
        if done:
            self._records.audit_once(_BY_COMMAND, done)
            self._audited |= done.keys()


def _audit_text(entry: Entry) -> Iterator[tuple[str, tuple[str, str]]]:
    who = f"{entry.holder.value} {entry.name} as {entry.common_name}"
    until = f"until {entry.valid_to:%Y-%m-%d}"
    for serial in entry.earlier:  # of a certificate renewed before a station read it
        yield f"issued-{serial}", ("IssuedCertificate", f"{who}, renewed since")
    yield f"issued-{entry.serial}", ("IssuedCertificate", f"{who}, {until}")
    if entry.revoked is not None:
        at = f"at {entry.revoked:%Y-%m-%dT%H:%M:%SZ}"
        yield f"revoked-{entry.serial}", ("RevokedCertificate", f"{who}, {at}")
