"""Wire format between a station and its department, in msgpack.

Summaries (``department_summary_key``, once a second) are newest-only: what is lost is replaced by
the next one.  Events (``department_events_key``) go up as queries, in the order of their numbers,
until a receipt confirms that they are stored.  New fields have a default and stand at the end: an
older department skips fields that it does not know, and keeps events of an unknown kind.
"""

from __future__ import annotations

from typing import TypeVar

import msgspec

from shared.coded_text import TextCode
from shared.errors import WireError
from shared.messages.alarm import NO_PARAMETERS, AlarmParameters

W = TypeVar("W")


class PlaceSummary(msgspec.Struct, frozen=True, array_like=True):
    """A position, in the incident frame of the station."""

    t_ms: int  # to which it belongs
    north_m: float
    east_m: float
    floor: int | None
    lat_deg: float | None  # where the site has an anchor
    lon_deg: float | None
    radius_m: float  # major semi-axis of the 95 % region
    quality: str  # lower-case name of shared.quality.Quality


class PersonSummary(msgspec.Struct, frozen=True, array_like=True):
    """A unit and its wearer, as the station's consoles show them now."""

    unit_id: str
    label: str
    person_id: str  # empty: it is not worn; the name came as a ``PersonEvent``
    link: str  # live | stale | lost | never
    incident_id: str  # empty: in none
    place: PlaceSummary | None
    activity: str  # lower-case name of shared.messages.Activity; empty: unknown
    mayday: bool
    alarms: tuple[str, ...]  # ids of open alarms
    par: str  # self | radio | not_yet; empty: not on duty
    par_due_ms: int | None


class IncidentSummary(msgspec.Struct, frozen=True):
    incident_id: str
    name: str  # people in it as references
    opened_ms: int


class Summary(msgspec.Struct, frozen=True):
    """A station as it is now; times are its own."""

    epoch: int  # of its outbox; two of them at once are two machines with one name
    t_ms: int  # when it was sent
    host: str  # name of the machine
    console_url: str  # where browsers find it; empty: not configured
    incidents: tuple[IncidentSummary, ...]
    people: tuple[PersonSummary, ...]
    problems: tuple[str, ...]  # of the station's health, as sentences
    waiting: int  # events that are not acknowledged
    lat_deg: float | None = None  # of the station's site, where that has an anchor
    lon_deg: float | None = None
    problem_codes: tuple[TextCode, ...] = ()  # of ``problems``, in their order


class AlarmEvent(msgspec.Struct, frozen=True, tag="alarm"):
    """A transition of an alarm; texts name people by references."""

    alarm_id: str
    rule: str
    unit_id: str
    priority: int
    state: str  # raised | acknowledged | resolved
    level: str
    text: str
    by: str
    raised_ms: int
    changed_ms: int
    code: str = ""  # of the sentence in ``text``; empty: of an earlier version
    parameters: AlarmParameters = NO_PARAMETERS


class ParEvent(msgspec.Struct, frozen=True, tag="par"):
    """PAR of one member, as it is since then."""

    unit_id: str
    person_id: str
    incident_id: str
    confirmed: str  # self | radio | not_yet
    confirmed_ms: int | None
    requested_ms: int | None  # None: no request is open
    due_ms: int


class IncidentEvent(msgspec.Struct, frozen=True, tag="incident"):
    """Opening or end of an incident."""

    incident_id: str
    name: str
    opened_ms: int
    closed_ms: int | None  # None: it is open


class PersonEvent(msgspec.Struct, frozen=True, tag="person"):
    """Name of a person id, from then on."""

    person_id: str
    name: str  # empty: the person was erased, and is to be erased here
    crew: str
    role: str


EventBody = AlarmEvent | ParEvent | IncidentEvent | PersonEvent


_KINDS = ("alarm", "par", "incident", "person")


class _Tag(msgspec.Struct, frozen=True):
    type: str = ""


class Event(msgspec.Struct, frozen=True, array_like=True):
    seq: int  # of the station's outbox, without gaps
    event_id: str  # the same however often and from whichever machine of the station it comes
    t_ms: int  # of the event, station time
    body: msgspec.Raw  # an ``EventBody``


class EventBatch(msgspec.Struct, frozen=True):
    epoch: int
    t_ms: int  # the station's clock as it is sent
    after_seq: int  # the last number that the department has acknowledged; 0: none
    events: tuple[Event, ...]
    # Up to this number the station has dropped events while it was the standby of two: the other
    # one has sent them.
    dropped_seq: int = 0


class EventReceipt(msgspec.Struct, frozen=True):
    """Answer to a batch."""

    epoch: int
    stored_seq: int  # up to here all are on the department's disk
    refusal: str = ""  # why nothing was stored, as a sentence


def pack(message: msgspec.Struct) -> bytes:
    return msgspec.msgpack.encode(message)


def unpack(payload: bytes, kind: type[W]) -> W:
    """Raises WireError where the bytes are something else."""
    try:
        return msgspec.msgpack.decode(payload, type=kind)
    except msgspec.MsgspecError as error:
        raise WireError(f"this is no report to a department: {error}") from error


def kind_of(body: EventBody | None) -> str:
    """Alarm | par | incident | person; empty: of a kind that a newer station sends."""
    return "" if body is None else str(body.__struct_config__.tag)


def unpack_body(body: msgspec.Raw) -> EventBody | None:
    """None: of a kind that a newer station sends.  Raises WireError where it is damaged."""
    if unpack(body, _Tag).type not in _KINDS:
        return None
    return unpack(body, EventBody)  # type: ignore[arg-type]  # a union is no class
