"""Forgets a person, or everybody in one incident: in the log, the database and the checkpoints.

The log goes first: interrupted, the whole is done again and ends as it would have.  What the
units' own journals and black boxes hold, what was exported and what another station holds is
beyond this station's reach: docs/security.md says what to do about it.
"""

from __future__ import annotations

import logging
import shutil
import time
from collections.abc import Callable, Collection, Iterable, Sequence
from concurrent.futures import Future
from operator import itemgetter
from pathlib import Path
from typing import Protocol

import msgspec

from base_station.core.erasure.erasure import (
    Erasure,
    Record,
    Wearing,
    actions_of,
    erasure_of_person,
)
from base_station.core.erasure.erasure_order import (
    ErasureOrder,
    actions_before,
    last_order,
    orders_of,
)
from base_station.core.erasure.incident_scan import erasure_of_incident
from base_station.core.erasure.names_in_older_logs import has_names
from base_station.engine.ports import ActionResult
from base_station.privacy.erasure_progress import ErasureProgress, ErasureResult, Progress
from base_station.privacy.log_files import LogFiles, LogReading
from base_station.privacy.log_rewriter import LogRewriter, RepairPending
from base_station.privacy.pending_erasure import PendingErasure
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.database import Database
from base_station.storage.db.erasure import (
    FORGOT_INCIDENT,
    FORGOT_PERSON,
    INCIDENT,
    erased_incidents,
    forget_in,
    known_names,
    wearings_of,
)
from base_station.storage.db.lost_actions import lost_actions, worn_in
from base_station.storage.db.records import Records
from base_station.storage.imports import ImportFolder
from shared.clock import Clock
from shared.coded_text import coded
from shared.errors import StoreError, UserError
from shared.messages.station import (
    Action,
    BeginErasure,
    ForgetWearers,
    OpenIncident,
    TakeOver,
)

_log = logging.getLogger(__name__)
BY_OTHER_STATION = "the other station"  # requests here the erasures done there
_RADIO_KEPT = coded(
    "erasure-radio-kept",
    "What was recorded of the radio while another incident was open stays until that is forgotten, "
    "too: nobody can tell who of them speaks",
)
_IMPORTS_KEPT = coded(
    "erasure-imports-kept",
    "Files that were brought in stay as they came, with people and voices in them: take out those "
    "that have the person",
)
PERSON = "person"
_ACTED_WITHIN_S = 20.0
_REMOVED_WITHIN_S = 20.0
EraseAudio = Callable[[int, int], int]  # station times, the second left out; gives packets
Act = Callable[[str, Action], Future[ActionResult] | None]  # None: this station does not lead


class RecordingTransfers(Protocol):
    """Raw recordings that are being pulled from units."""

    def forget(self, unit_ids: Collection[str]) -> None:
        """End all transfers from these units."""
        ...


class ErasureService:
    """Erasures, one at a time; called from any thread but the engine's, for which it waits."""

    def __init__(
        self,
        log: LogFiles,
        store: Database,
        checkpoints: Checkpoints,
        records: Records,
        clock: Clock,
        transfers: RecordingTransfers,
        act: Act | None = None,
        is_repair_pending: RepairPending = lambda _path, _damage: False,
        forget_name: Callable[[str], None] = lambda _person_id: None,
        erase_audio: EraseAudio = lambda _from_ns, _until_ns: 0,
    ) -> None:
        """``act`` performs an action of the running station: it erases its memory and orders the
        erasure; None: no station runs on the folder.  ``is_repair_pending``: True where the lost
        part of a segment is about to be fetched from the other station.  ``forget_name`` removes a
        person's name from what the station shows.  ``erase_audio`` is called for whole incidents
        only: audio does not say which person speaks.
        """
        self._log = log
        self._reading = LogReading(log)
        self._rewriter = LogRewriter(log, records, is_repair_pending)
        self._store = store
        self._checkpoints = checkpoints
        self._records = records
        self._clock = clock
        self._transfers = transfers
        self._act = act
        self._forget_name = forget_name
        self._erase_audio = erase_audio
        folder = DataFolder(log.folder.parent)
        self._begun = PendingErasure(folder.pending_erasures)
        self._imports = ImportFolder(folder.imports)

    def erase_person(
        self,
        by: str,
        person_id: str,
        on_progress: Progress = lambda _: None,
        progress: ErasureProgress | None = None,
        *,
        from_peer: bool = False,
    ) -> ErasureResult:
        """Erase a person; ``from_peer``: the other station has done so already.

        Raises UserError where the person is unknown.  A repeated erasure raises none: only the
        audit may still know the person.
        """
        progress = progress or ErasureProgress()
        found, is_known = self._erasure_of_person(person_id, None)
        if not (progress.again or is_known):
            raise _unknown(person_id)
        order = self._ordered(by, PERSON, person_id, found, from_peer=from_peer)
        erasure, _ = self._erasure_of_person(person_id, order)
        return self._erase(by, erasure, order, f"{PERSON} {person_id}", on_progress, progress)

    def require_person(self, person_id: str) -> None:
        """Raise UserError where the person is unknown."""
        if not self._erasure_of_person(person_id, None)[1]:
            raise _unknown(person_id)

    def erase_incident(
        self,
        by: str,
        incident_id: str,
        on_progress: Progress = lambda _: None,
        progress: ErasureProgress | None = None,
        *,
        from_peer: bool = False,
    ) -> ErasureResult:
        """Erase an incident; ``from_peer`` as for a person.

        Raises UserError where there is no such incident, or it is open.
        """
        begun = self._begun.of(incident_id)
        found = begun or self._erasure_of_incident(incident_id, None)
        order = self._ordered(by, INCIDENT, incident_id, found, from_peer=from_peer)
        erasure = begun or self._erasure_of_incident(incident_id, order)
        if begun is None:
            self._begun.keep(erasure)
        progress = progress or ErasureProgress()
        return self._erase(by, erasure, order, f"{INCIDENT} {incident_id}", on_progress, progress)

    def is_of_pair(self) -> bool:
        """True where the log is shared with another station, or was."""
        return any(
            isinstance(one.action, TakeOver) for _, one in actions_of(self._reading.actions())
        )

    def _erasure_of_person(
        self, person_id: str, order: ErasureOrder | None
    ) -> tuple[Erasure, bool]:
        """Extent of the erasure, and True where tables or log know the person.

        Names are searched for only where a log has names: older logs do.
        """
        with self._store.read() as session:
            names = known_names(session, person_id)
        actions = actions_before(self._reading.actions(), order)
        everywhere = (*actions, *self._reading.actions_set_aside())
        has_older = has_names(one for _, one in actions_of(everywhere))
        until_ns = self._clock.utc_ns() if order is None else order.t_ns
        found = erasure_of_person(actions, person_id, names if has_older else (), until_ns)
        if not self._reading.is_whole():
            found = self._with_lost_wearings(found, until_ns)
        return found, bool(found.wearings or names)

    def _with_lost_wearings(self, found: Erasure, until_ns: int) -> Erasure:
        """Add the times of wearing a unit that the tables have: a part of the log is gone."""
        with self._store.read() as session:
            return _with_wearings(found, wearings_of(session, found.person_id, until_ns))

    def _erasure_of_incident(self, incident_id: str, order: ErasureOrder | None) -> Erasure:
        in_log = self._reading.actions()
        actions = actions_before(in_log, order)
        if self._reading.is_whole() or _opens(incident_id, actions):
            return self._scanned(incident_id, actions)
        with self._store.read() as session:
            lost = lost_actions(session, {one.action_id for _, one in actions_of(in_log)})
            found = self._scanned(incident_id, sorted((*lost, *actions), key=itemgetter(0)))
            return _with_wearings(found, worn_in(session, incident_id))

    def _scanned(self, incident_id: str, actions: Sequence[Record]) -> Erasure:
        return erasure_of_incident(
            actions,
            incident_id,
            self._reading.first_message_ns(actions),
            is_whole=self._reading.is_whole(),
        )

    def _ordered(
        self, by: str, kind: str, subject_id: str, found: Erasure, *, from_peer: bool
    ) -> ErasureOrder | None:
        """Erase the memory of a station that leads, and order the erasure in the log; at one that
        follows, the order of the other.  None: there is none, and the whole log is rewritten.

        Raises StoreError where this station may not do it now.
        """
        if self._act is None:
            return None
        self._erase_in_memory(by, found)
        acted = self._act(by, BeginErasure(kind, subject_id))
        if acted is None:
            if not from_peer:
                raise StoreError(
                    coded(
                        "erasure-not-leading",
                        "this station does not lead; the one that leads orders it",
                    )
                )
            self._log.complete_segments()  # on the disk, to be read
            return last_order(self._reading.actions(), kind, subject_id)
        done = _result(acted)
        if done.refused is not None:
            raise StoreError(done.refused.reason)
        self._log.complete_segments()
        orders = (order for order, _ in orders_of(self._reading.actions()))
        unread = ErasureOrder(
            done.action_id, done.t_ns, by
        )  # damaged meanwhile: the log to its end
        return next((one for one in orders if one.action_id == done.action_id), unread)

    def _erase(
        self,
        by: str,
        erasure: Erasure,
        order: ErasureOrder | None,
        what: str,
        on_progress: Progress,
        progress: ErasureProgress,
    ) -> ErasureResult:
        self._checkpoints.clear()
        self._remove_recordings(erasure, progress)
        self._rewriter.rewrite(erasure, order, on_progress, progress)
        if erasure.incident_id:
            self._erase_radio(erasure, progress)
        with self._store.write() as session:
            forget_in(session, erasure)
        progress.files += self._store.compact()
        if erasure.incident_id:
            progress.files += self._imports.remove_all(erasure.incident_id)
        elif any(self._imports.files()):
            progress.kept = (_IMPORTS_KEPT,)
        self._checkpoints.clear()  # one that was being written meanwhile
        self._begun.remove(erasure.incident_id)
        done = ErasureResult(
            what, progress.records, progress.files, progress.damaged, progress.kept
        )
        kind = FORGOT_PERSON if erasure.person_id else FORGOT_INCIDENT
        self._records.audit(by, kind, str(done))
        _log.info("forgotten at the wish of %s: %s", by, done)
        return done

    def _erase_radio(self, erasure: Erasure, progress: ErasureProgress) -> None:
        """Erase the audio of the incident's time.  Audio of a time at which another incident was
        open belongs to both: it is erased with the last of them.
        """
        with self._store.read() as session:
            erased = erased_incidents(session)
        for from_ns, until_ns in erasure.times_alone(erased):
            progress.records += self._erase_audio(from_ns, until_ns)
        if any(one.incident_id not in erased for one in erasure.others):
            progress.kept = (_RADIO_KEPT,)

    def _erase_in_memory(self, by: str, erasure: Erasure) -> None:
        """Erase in the memory of the running station; done when this returns.

        Only then the rest is erased: the station would save what it still has in memory again.
        """
        if erasure.person_id:
            self._forget_name(erasure.person_id)
        if self._act is None:
            return
        acted = [self._act(by, ForgetWearers(unit_id)) for unit_id in sorted(erasure.unit_ids)]
        for one in acted:
            if one is not None:
                _result(one)

    def _remove_recordings(self, erasure: Erasure, progress: ErasureProgress) -> None:
        """Remove the raw recordings of the units, of all their wearers: the units have them still.

        A transfer that is under way ends, as its folder is gone.
        """
        self._transfers.forget(erasure.unit_ids)
        recordings = DataFolder(self._log.folder.parent).recordings
        for folder in (recordings / unit_id for unit_id in sorted(erasure.unit_ids)):
            files = sum(1 for path in folder.rglob("*") if path.is_file())
            _remove(folder)
            progress.files += files


def _with_wearings(found: Erasure, known: Iterable[Wearing]) -> Erasure:
    wearings = {*found.wearings, *known}
    in_order = sorted(wearings, key=lambda one: (one.from_ns, one.unit_id, one.until_ns))
    return msgspec.structs.replace(found, wearings=tuple(in_order))


def _opens(incident_id: str, actions: Iterable[Record]) -> bool:
    opened = (one.action for _, one in actions_of(actions) if isinstance(one.action, OpenIncident))
    return any(one.incident_id == incident_id for one in opened)


def _unknown(person_id: str) -> UserError:
    return UserError(
        coded(
            "unknown-person",
            "neither the roster nor the log knows a person {person_id}",
            person_id=person_id,
        )
    )


def _result(acted: Future[ActionResult]) -> ActionResult:
    try:
        return acted.result(_ACTED_WITHIN_S)
    except TimeoutError as error:
        raise StoreError(
            coded("erasure-memory-timeout", "the station did not get to what it holds in memory")
        ) from error


def _remove(folder: Path) -> None:
    """Remove a folder; tries again while a transfer still writes its last file into it."""
    end_s = time.monotonic() + _REMOVED_WITHIN_S
    while folder.exists():
        shutil.rmtree(folder, ignore_errors=True)
        if time.monotonic() > end_s:
            raise StoreError(
                coded(
                    "erasure-folder-in-use",
                    "{folder} cannot be removed; see who uses it, and forget again",
                    folder=str(folder),
                )
            )
