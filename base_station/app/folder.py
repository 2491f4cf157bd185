"""What is done with a station's folder beside a running station, or without one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from base_station.app.given import open_given
from base_station.app.parts import project_whole_log
from base_station.assessment.wearers import wearers
from base_station.db.accounts import Accounts
from base_station.db.forgetting import ids_of
from base_station.db.models import Incident
from base_station.db.records import Records
from base_station.db.roster import Roster
from base_station.db.smoothed import SmoothedTracks
from base_station.db.store import Store
from base_station.forgetting.desk import forget_now
from base_station.forgetting.forgetter import ClosedLog, Forgetter, Forgotten
from base_station.fusion.smoother import SMOOTHERS
from base_station.past.checkpoints import Checkpoints
from base_station.past.hindsight import Hindsight
from base_station.recordings.desk import RecordingDesk
from base_station.standby.places import Place
from base_station.standby.setting_aside import set_aside
from base_station.storage.data_folder import DataFolder
from shared.clock import SystemClock
from shared.errors import UserError
from shared.mcap_log import recover_log

_BY_COMMAND = "muster base forget"  # in the audit


@dataclass(frozen=True)
class LookBack:
    """What commands about a past incident work with."""

    hindsight: Hindsight
    records: Records
    incident: Incident
    people: Mapping[str, Sequence[str]]  # who wore each unit
    keeps: bool  # what is worked out; else it is gone with the command


def rebuild(data: Path, on_progress: Callable[[float], None]) -> int:
    """Make the projections of a folder again; no station may be running on it.

    ``on_progress`` hears the fraction done.  Gives the number of log records.
    """
    folder = DataFolder(data)
    folder.require()
    lock = folder.lock()
    try:
        with Store(folder.database) as store:
            return project_whole_log(store, folder.log, on_progress)
    finally:
        lock.close()


def cut_log(data: Path, place: Place, on_progress: Callable[[float], None]) -> None:
    """Set aside what the log has behind a place, and make the projections again without it."""
    folder = DataFolder(data)
    lock = folder.lock()
    try:
        with Store(folder.database) as store:  # it must not know what is cut, however this ends
            Records(store, SystemClock()).forget_projections()
        set_aside(folder, place)
    finally:
        lock.close()
    rebuild(data, on_progress)


def forget(
    data: Path, what: str, confirm: Callable[[str], None], on_progress: Callable[[float], None]
) -> Forgotten:
    """Forget a person (id or name) or an incident (id) in a folder that no station runs on.

    ``confirm`` gets what it will be about and may raise.  Cut short, the station goes on with it
    when it is started.
    """
    folder = DataFolder(data)
    folder.require()
    lock = folder.lock()
    try:
        recover_log(folder.log)
        with Store(folder.database) as store:
            clock = SystemClock()
            records, roster = Records(store, clock), Roster(store, clock)
            forgetter = Forgetter(
                ClosedLog(folder.log),
                store,
                Checkpoints(folder.checkpoints),
                records,
                clock,
                RecordingDesk(_ask_nobody, folder.recordings, clock),
            )
            incident = records.incident(what)
            if incident is None:
                kind, about = "person", f"person {what}"
                subject_id = _person_called(what, roster, store)
            else:
                kind, subject_id, about = "incident", what, f"incident {incident.name!r} of {what}"
            _require_nobody_in_action(records)
            confirm(about)
            return forget_now(
                forgetter, folder.forgettings, _BY_COMMAND, kind, subject_id, on_progress
            )
    finally:
        lock.close()


def _person_called(what: str, roster: Roster, store: Store) -> str:
    """The id, whether or not the person is on the roster still; UserError where that is not one
    person, or the person wears a unit.
    """
    with store.read() as session:
        named = sorted(ids_of(session, what))
    if len(named) > 1:
        raise UserError(f"{len(named)} people are or were called {what}: give one of {named}")
    person_id = named[0] if named else what
    if worn := roster.worn_by(person_id):
        raise UserError(f"{what} wears {', '.join(worn)}; unassign that first")
    return person_id


def _require_nobody_in_action(records: Records) -> None:
    for incident in records.incidents():
        if incident.closed_ns is None:
            raise UserError(f"the incident {incident.name} is open; close it first")


def _ask_nobody(_unit_id: str, _question: str) -> None:
    return None


def look_back(
    data: Path,
    incident_id: str,
    closing: ExitStack,
    tell: Callable[[str], None],
    on_progress: Callable[[float], None],
) -> LookBack:
    """A past incident, beside a running station or without one; also of what somebody gave.

    ``tell`` hears in words of what of it cannot be read, ``on_progress`` the fraction done where
    the log must be read first.
    """
    given = open_given(data, incident_id, closing, tell, on_progress, in_place=True)
    clock = SystemClock()
    records = Records(given.store, clock)
    incident = records.require_incident(incident_id)
    hindsight = Hindsight(given.archive(), SMOOTHERS[0], SmoothedTracks(given.store), clock)
    people = wearers(Roster(given.store, clock), incident)
    return LookBack(hindsight, records, incident, people, given.keeps)


def open_accounts(data: Path, closing: ExitStack) -> tuple[Accounts, Records]:
    """Accounts and audit of a folder's database, beside a running station or without one."""
    store = closing.enter_context(Store(DataFolder(data).require_database()))
    return Accounts(store, SystemClock()), Records(store, SystemClock())
