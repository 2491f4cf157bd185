"""An incident as one MCAP file that stands alone: it needs neither the station's folder nor its
database (decision 119).

In it are, in the order of the log: earlier settings that still held when the incident was opened
(units and wearers, plan, place on the Earth, fuser, thresholds, beacons), all records from some
minutes before the opening until a minute after the closing, and later ones of journals, of a
debriefing and of files that were brought in.  The people who are mentioned, the plan, and these
files are attached.  The audio of the radio channels is in it on request.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from heapq import merge
from importlib.metadata import version
from pathlib import Path

import msgspec

from base_station.core.events import Received, event_of
from base_station.core.pins.pin_registry import PinAction
from base_station.core.state import ERASED_TEXT
from base_station.engine.log_feed import LogFeed
from base_station.radio.radio_log import RadioLog
from base_station.storage.db.known_people import KnownPerson
from base_station.storage.db.models import IncidentRow
from shared.channels import DESCRIPTION, OPERATOR, is_backfilled
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import LogError, UserError
from shared.mcap_log import LogRecord, Segment, SegmentIdentity, enclosures_of, read_attached
from shared.messages import STATION_ID, OperatorAction
from shared.messages.pins import PlaceBeacon, RemoveBeacon
from shared.messages.station import (
    Action,
    Assign,
    CloseIncident,
    ImportFile,
    NoteDispatch,
    OpenIncident,
    RegisterUnit,
    RemoveImport,
    SetAnchor,
    SetFuser,
    SetPlan,
    SetReference,
    SetStart,
    SetThresholds,
    Unassign,
)

METADATA_NAME = "muster.incident"
PEOPLE_NAME = "people.json"
PLAN_NAME = "plan.geojson"
BEFORE_NS = 900 * NS_PER_S  # units are switched on and placed before an incident is opened
AFTER_NS = 60 * NS_PER_S
_CHUNK_BYTES = 2 << 20
_PART_BYTES = 1 << 20
_DISPATCH = "dispatch"
_ANY_TYPE = "application/octet-stream"
_OPERATOR_KEY = OPERATOR.key(STATION_ID)
Progress = Callable[[float], None]


class IncidentInFile(msgspec.Struct, frozen=True):
    """Header of a stand-alone file."""

    incident_id: str
    name: str
    people: dict[str, KnownPerson]  # by id, those who are mentioned in it


@dataclass(frozen=True)
class IncidentFileSource:
    """``name`` and ``people`` are as they are shown; ``report`` receives a sentence about each part
    of the log that cannot be read, which is also written into the file.
    """

    log: LogFeed
    incident: IncidentRow
    name: str
    people: Mapping[str, KnownPerson]
    plan: bytes | None
    until_ns: int  # where an incident ends that is open
    imports: Mapping[str, Path] = field(default_factory=dict)  # files brought in, by name
    radio: RadioLog | None = None  # None: without audio
    report: Callable[[str], object] = lambda _: None
    on_progress: Progress = field(default=lambda _: None)


def incident_file(source: IncidentFileSource) -> Iterator[bytes]:
    """The file's content, part by part; nothing is written to a disk."""
    incident = source.incident
    end_ns = incident.closed_ns or source.until_ns
    part = Segment(Path(METADATA_NAME), _CHUNK_BYTES, SegmentIdentity(source.log.log_id))
    mentioned: set[str] = set()
    damage: dict[str, None] = {}  # each once, though the log is gone through more than once
    log = source.log.noting(damage.setdefault)
    records: Iterator[LogRecord] = _records(log, incident, end_ns)
    if source.radio is not None:
        audio = source.radio.records(incident.opened_ns, end_ns)
        records = merge(records, audio, key=lambda record: record[0])
    for record in records:
        t_ns, key, payload = record
        if key == _OPERATOR_KEY:
            mentioned |= {one for one in source.people if one.encode() in payload}
        part.add(t_ns, key, payload)
        if part.file.waiting_bytes > _PART_BYTES:
            yield part.file.take()
            done = (t_ns - incident.opened_ns) / max(end_ns - incident.opened_ns, 1)
            source.on_progress(min(max(done, 0.0), 1.0))
    for words in damage:
        source.report(words)
    _enclose(part, source, mentioned, damage, end_ns)
    for name, path in source.imports.items():
        for _ in part.add_attachment_file(name, _ANY_TYPE, path, end_ns):
            yield part.file.take()
    part.finish()
    yield part.file.take()


def _enclose(
    part: Segment,
    source: IncidentFileSource,
    mentioned: set[str],
    damage: Iterable[str],
    end_ns: int,
) -> None:
    incident = source.incident
    people = {one: source.people[one] for one in sorted(mentioned)}
    known = {
        person_id: msgspec.structs.replace(person, photo_url=None)
        for person_id, person in people.items()
        if person.name != ERASED_TEXT
    }
    part.add_attachment(PEOPLE_NAME, "application/json", msgspec.json.encode(known), end_ns)
    if source.plan is not None:
        part.add_attachment(PLAN_NAME, "application/geo+json", source.plan, end_ns)
    about = {
        "muster_version": version("muster"),
        "incident_id": incident.incident_id,
        "name": source.name,
        "opened": _iso(incident.opened_ns),
        "closed": _iso(incident.closed_ns) if incident.closed_ns else "",
        "damage": "; ".join(damage),
    }
    part.add_metadata(METADATA_NAME, about)


def _records(log: LogFeed, incident: IncidentRow, end_ns: int) -> Iterator[LogRecord]:
    opened_ns = incident.opened_ns
    standing = _Standing()
    from_ns = opened_ns - BEFORE_NS
    for record in log.records(None, opened_ns + NS_PER_S, _SettingKeys()):
        action = _action_of(record)
        if isinstance(action, OpenIncident) and action.incident_id == incident.incident_id:
            standing.keep_dispatch(action.dispatch_number)
            break
        standing.note(record)
        if isinstance(action, CloseIncident):
            from_ns = max(from_ns, record[0] + 1)  # earlier records are of another incident
    yield from standing.records(from_ns)
    yield from log.everything(from_ns, end_ns + AFTER_NS, _AllKeys())
    if incident.closed_ns is None:
        return
    next_ns = None  # when another one was opened
    for record in log.records(end_ns + AFTER_NS):
        action = _action_of(record)
        if isinstance(action, OpenIncident):
            next_ns = record[0]
            break
        is_about = isinstance(action, PinAction) or _is_import(action, incident)
        if is_backfilled(record[1]) or is_about:
            yield record
    if next_ns is not None:
        for record in log.records(next_ns + 1, None, {_OPERATOR_KEY}):
            if _is_import(_action_of(record), incident):
                yield record


def _is_import(action: Action | None, incident: IncidentRow) -> bool:
    """A file was brought into the incident, or taken out."""
    match action:
        case ImportFile(incident_id=incident_id) | RemoveImport(incident_id=incident_id):
            return incident_id == incident.incident_id
        case _:
            return False


class _SettingKeys:
    """Keys of actions of people, and of descriptions of units."""

    def __contains__(self, key: object) -> bool:
        return key == _OPERATOR_KEY or (isinstance(key, str) and key.endswith(DESCRIPTION.suffix))


class _AllKeys:
    """All keys, those of derived records too."""

    def __contains__(self, _: object) -> bool:
        return True


class _Standing:
    """Settings that still hold, each once."""

    def __init__(self) -> None:
        self._records: dict[tuple[str, str], LogRecord] = {}

    def note(self, record: LogRecord) -> None:
        what = _what_it_sets(record)
        if what is not None:
            self._records.pop(what, None)  # it goes behind settings made meanwhile
            self._records[what] = record

    def keep_dispatch(self, number: str) -> None:
        """Keeps the dispatch from which the incident was opened; empty: none."""
        others = [what for what in self._records if what[0] == _DISPATCH and what[1] != number]
        for what in others:
            del self._records[what]

    def records(self, until_ns: int) -> Iterator[LogRecord]:
        """Those of before a time, as of just before it: days in which nothing is are left out."""
        for t_ns, key, payload in self._records.values():
            if t_ns < until_ns:
                yield until_ns - 1, key, payload


def _what_it_sets(record: LogRecord) -> tuple[str, str] | None:
    """The thing that a record sets anew; None: nothing that outlives an incident."""
    if record[1] != _OPERATOR_KEY:
        return "description", record[1]
    action = _action_of(record)
    match action:
        case NoteDispatch():
            return _DISPATCH, action.number
        case Assign() | Unassign():
            return "wearer", action.unit_id
        case RegisterUnit() | SetStart():
            return type(action).__name__, action.unit_id
        case PlaceBeacon() | RemoveBeacon():
            return "beacon", action.beacon_id
    is_of_site = isinstance(action, SetAnchor | SetFuser | SetPlan | SetReference | SetThresholds)
    return (type(action).__name__, "") if is_of_site else None


def _action_of(record: LogRecord) -> Action | None:
    """Action of a person; None: another kind of record, or damaged."""
    if record[1] != _OPERATOR_KEY:
        return None
    event = event_of(*record)
    message = event.message if isinstance(event, Received) else None
    return message.action if isinstance(message, OperatorAction) else None


def _iso(t_ns: int) -> str:
    return datetime.fromtimestamp(t_ns / NS_PER_S, UTC).isoformat(timespec="milliseconds")


def read_incident_file(path: Path) -> IncidentInFile | None:
    """None where it is no such file, or is not complete.  Raises UserError where it is one and not
    valid.
    """
    enclosed = enclosures_of(path)
    about = enclosed.metadata.get(METADATA_NAME)
    if about is None:
        return None
    try:
        attached = enclosed.attachments.get(PEOPLE_NAME)
        encoded = b"{}" if attached is None else b"".join(read_attached(path, attached))
        people = msgspec.json.decode(encoded, type=dict[str, KnownPerson])
        return IncidentInFile(about["incident_id"], about["name"], people)
    except LogError:
        return None
    except (KeyError, msgspec.MsgspecError) as error:
        raise UserError(
            coded(
                "incident-file-damaged",
                "{path} is marked as an incident of Muster, and cannot be read as one ({error}): "
                "get it once more",
                path=str(path),
                error=str(error),
            )
        ) from error
