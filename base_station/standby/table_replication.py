"""Keeps data that is in no log the same at both stations: accounts, people, the base map, audit,
enrolments.

The standby asks in every round whether anything has changed; the answer is all of it, or nothing.
The active one asks the same, applies removals of the other (users, tokens, roles), and takes back
rows that it has lost with its own database.  Audit entries are copied in both directions, in the
order in which the other one got them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from threading import Event

import msgspec

from base_station.privacy.erasure_service import BY_OTHER_STATION
from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.registry import Registry
from base_station.standby.protocol import pack, unpack
from base_station.standby.rpc import RpcServer, ask
from base_station.storage.db.erasure import FORGOT_INCIDENT, FORGOT_PERSON
from base_station.storage.db.replicated_rows import ReplicatedRows, Row
from base_station.storage.db.replicated_tables import ReplicatedTables
from shared.bus import Bus

_AUDIT_ENTRIES = 500
_FORGOTTEN = FORGOT_PERSON, FORGOT_INCIDENT


class TableServer(RpcServer):
    """Serves ``tables/`` all, photo, base-map, audit and enrolled."""

    def __init__(self, station: str, bus: Bus, tables: ReplicatedTables, pki: PkiFolder) -> None:
        self._tables = tables
        self._pki = pki
        super().__init__(
            station,
            bus,
            {
                "tables/all": self._all,
                "tables/photo": self._photo,
                "tables/base-map": self._base_map,
                "tables/audit": self._audit,
                "tables/enrolled": self._enrolled,
            },
        )

    def _all(self, _key: str, _parameters: str, payload: bytes) -> Iterator[bytes]:
        """Nothing where the asker knows it by its hash."""
        rows_bytes = pack(self._tables.read())
        if _hash(rows_bytes) != payload:
            yield rows_bytes

    def _enrolled(self, _key: str, _parameters: str, payload: bytes) -> Iterator[bytes]:
        """As ``tables/all``."""
        registry_bytes = pack(self._pki.registry()) if self._pki.exists() else payload
        if registry_bytes != payload and _hash(registry_bytes) != payload:
            yield registry_bytes

    def _photo(self, _key: str, _parameters: str, payload: bytes) -> Iterator[bytes]:
        photo = self._tables.photo(payload.decode())
        if photo is not None:
            yield photo

    def _base_map(self, _key: str, _parameters: str, payload: bytes) -> Iterator[bytes]:
        image = self._tables.base_map(payload.decode())
        if image is not None:
            yield image

    def _audit(self, _key: str, _parameters: str, payload: bytes) -> Iterator[bytes]:
        entries = self._tables.audit_behind(int(payload), _AUDIT_ENTRIES)
        yield msgspec.msgpack.encode(entries)


class TableReplication:
    """Copies in rounds, for as long as another station is there."""

    def __init__(
        self,
        bus: Bus,
        tables: ReplicatedTables,
        pki: PkiFolder,
        leader: Callable[[], str | None],
        other: Callable[[], str | None],
        others_run: Callable[[], int],
        caught_up: Callable[[], bool],
        has_until: Callable[[int], bool],
        on_people: Callable[[], None],
        on_forgotten: Callable[[str], None],
        on_dropped: Callable[[str], None],
        on_restored_rows: Callable[[str], None],
    ) -> None:
        """``leader``: station to copy from, where that is another; ``other``: station whose audit
        to add, when this log has ``caught_up``: data that it orders to forget must be there.
        ``has_until``: whether this log has what the other's had at a time: then it has the record
        that orders an erasure.  ``others_run``: run of its program; another one where it started
        again, perhaps on another machine.

        ``on_people`` is called when people or photos may have changed, ``on_forgotten`` with a
        person or an incident ("person ID") that the other station has forgotten, and again if that
        cannot be noted, ``on_dropped`` with a sentence about rows that were only here,
        ``on_restored_rows`` with one about rows that this one had lost.
        """
        self._bus = bus
        self._tables = tables
        self._pki = pki
        self._leader = leader
        self._other = other
        self._others_run = others_run
        self._caught_up = caught_up
        self._has_until = has_until
        self._on_people = on_people
        self._on_forgotten = on_forgotten
        self._on_dropped = on_dropped
        self._copied_digest = self._enrolled_digest = self._standby_digest = b""
        self._on_restored_rows = on_restored_rows
        self._base_map: tuple[Row, ...] = ()  # of the leader
        self._audit_number = 0  # up to which the other station's audit is here
        self._audit_run = 0  # of its program, in which that was counted

    def run_round(self, stop: Event) -> None:
        """Exchange changed rows with the other station; ``stop`` ends it early.  Raises
        MusterError where the bus or a store fails.
        """
        leader, other = self._leader(), self._other()
        if leader is not None:
            self._copy(leader, stop)
        elif other is not None:
            self._take_from_standby(other, stop)
        if other is not None:
            self._take_enrolled(other)
        if other is not None and self._caught_up():
            self._add_audit(other)

    def _copy(self, leader: str, stop: Event) -> None:
        rows_bytes = self._ask(leader, "all", self._copied_digest)
        if rows_bytes is not None:
            rows = unpack(rows_bytes, ReplicatedRows)
            lost = self._tables.lost()
            dropped = self._tables.copy(rows)
            if lost and not self._tables.lost():
                self._on_restored_rows(f"copied again from the other station: {', '.join(lost)}")
            self._base_map = rows.base_map
            if dropped and not self._copied_digest:  # else the active station has removed them
                self._on_dropped(f"only at this station, and gone: {', '.join(dropped)}")
            self._copied_digest = _hash(rows_bytes)
        missing = self._copy_photos(leader, stop)
        self._copy_base_map(leader)
        if rows_bytes is not None or missing:
            self._on_people()

    def _take_from_standby(self, other: str, stop: Event) -> None:
        """Take rows from the standby, where no other station leads."""
        rows_bytes = self._ask(other, "all", self._standby_digest)
        if rows_bytes is None:
            return
        rows = unpack(rows_bytes, ReplicatedRows)
        if self._tables.lacks_base_map():
            self._base_map = rows.base_map
            self._copy_base_map(other)
        back = self._tables.restore_lost_rows(rows)
        if back:
            self._on_restored_rows(f"back from the other station: {', '.join(back)}")
        taken_away, photos = self._tables.apply_removals(rows), self._copy_photos(other, stop)
        if back or taken_away or photos:
            self._on_people()
        self._standby_digest = _hash(rows_bytes)

    def _copy_photos(self, station: str, stop: Event) -> bool:
        """True if some had not come yet."""
        missing = self._tables.missing_photos()
        for person_id in missing:
            if stop.is_set():
                break
            photo = self._ask(station, "photo", person_id.encode())
            if photo is not None:
                self._tables.put_photo(person_id, photo)
        return bool(missing)

    def _copy_base_map(self, leader: str) -> None:
        for row in self._base_map:
            if self._tables.has_base_map(row):
                continue
            image = self._ask(leader, "base-map", str(row["image_hash"]).encode())
            if image is not None:
                self._tables.put_base_map(row, image)

    def _add_audit(self, other: str) -> None:
        run = self._others_run()
        if run != self._audit_run:
            self._audit_run, self._audit_number = run, 0
        answer = self._ask(other, "audit", b"%d" % self._audit_number)
        entries = [] if answer is None else unpack(answer, list[Row])
        if not entries:
            return
        new = self._tables.unknown_audit(entries)
        early = next((one for one in new if not self._can_take(one)), None)
        if early is not None:  # it is requested again
            new = new[: new.index(early)]
            entries = entries[: entries.index(early)]
        for entry in new:
            # What this one wished itself comes back where the other leads, from where this one may
            # have copied until then what it had forgotten; one that leads copies nothing.
            heeds = entry["by"] != BY_OTHER_STATION or self._leader() == other
            if heeds and entry["action"] in _FORGOTTEN:
                # Before the entry is here, which is how it is known the next time.
                self._on_forgotten(str(entry["detail"]).partition(":")[0])
        self._tables.add_audit(new)
        if entries:
            self._audit_number = int(entries[-1]["number"])

    def _can_take(self, entry: Row) -> bool:
        return entry["action"] not in _FORGOTTEN or self._has_until(int(entry["t_ns"]))

    def _take_enrolled(self, other: str) -> None:
        registry_bytes = self._ask(other, "enrolled", self._enrolled_digest)
        if registry_bytes is not None and self._pki.exists():
            self._pki.take_registry(unpack(registry_bytes, Registry))
            self._enrolled_digest = _hash(registry_bytes)

    def _ask(self, station: str, what: str, payload: bytes) -> bytes | None:
        return next(iter(ask(self._bus, station, f"tables/{what}", payload)), None)


def _hash(content: bytes) -> bytes:
    return hashlib.sha256(content).digest()
