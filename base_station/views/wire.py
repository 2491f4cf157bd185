"""Messages to the console over the WebSocket ``/api/v1/live``: a snapshot, then what changes.

Both carry ``seq``; a delta whose ``seq`` is not the last one plus one means that the console
missed something and must ask for a snapshot (send ``{"type": "snapshot"}``).  The trails that
were behind the units at the snapshot come one by one, whenever no delta has to go out.

``/api/v1/live`` gives ``Delta`` messages, with each changed unit whole.  With ``?deltas=fields``
it gives ``FieldDelta`` instead, with the fields that changed.  Who asks for these also confirms
what was shown: it sends ``{"type": "shown", "count": N}``, where N is the number of messages that
it got over this connection, of any type, and is done with.  Until the last snapshot or delta is
confirmed, changes are merged; the next ``FieldDelta`` has all of them, and names in ``after_seq``
the message that it follows.  Messages are compressed where the console offers it
(permessage-deflate).

Times are milliseconds since 1970 (station time; in a replay, the time of the incident).
Positions are metres north, east and down in the incident frame.  The console's
``src/wire.ts`` and the page ``docs/live.md`` are generated from these types (``python -m
tests.rig.console_types``).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Final, Literal

import msgspec

from base_station.views.answer import Answer

Link = Literal["live", "stale", "lost", "never"]


def shown_as(typescript: str, schema: dict[str, Any]) -> msgspec.Meta:
    """Type in the console, and as JSON schema, of what has no exact type here."""
    return msgspec.Meta(extra={"typescript": typescript}, extra_json_schema=schema)


def one_of(*values: str) -> msgspec.Meta:
    """Values that a string may have."""
    return shown_as(" | ".join(f'"{value}"' for value in values), {"enum": values})


_POINTS: Final = shown_as(
    "TrailPoint[]", {"type": "array", "items": {"$ref": "#/$defs/TrailPoint"}}
)


class PersonView(Answer, frozen=True):
    person_id: str
    name: str
    crew: str
    role: str
    photo_url: str | None


class SensorTemperatureView(Answer, frozen=True):
    """Reading of one named temperature sensor of a unit."""

    name: str
    temperature_degc: float


class StatusView(Answer, frozen=True):
    activity: str  # lower-case name of shared.messages.Activity
    motionless_s: float
    battery: float | None  # 0..1
    mayday: bool
    steps: int
    distance_m: float
    battery_left_s: int | None  # until it is empty; None: unknown
    battery_state: str  # lower-case name of shared.messages.BatteryState
    electronics: tuple[SensorTemperatureView, ...]  # inside the unit; not the air around it
    posture: str = "unknown"  # lower-case name of shared.messages.BodyPosture
    posture_confidence: float = 0.0  # its probability, 0..1
    mobility: str = "unknown"  # lower-case name of shared.messages.Mobility


class PositionView(Answer, frozen=True):
    t_ms: int  # the time to which the position belongs
    north_m: float
    east_m: float
    down_m: float
    floor: int | None
    ellipse_major_m: float  # semi-axes of the 95 % region
    ellipse_minor_m: float
    ellipse_heading_rad: float  # of the major axis, clockwise from north
    std_down_m: float
    heading_rad: float
    heading_std_rad: float
    quality: str  # lower-case name of shared.quality.Quality
    quality_reason: str
    since_gps_s: float | None
    lat_deg: float | None  # where the site has an anchor
    lon_deg: float | None
    floor_probability: float | None
    reach: tuple[tuple[float, float], ...]  # [east_m, north_m]; border of the ground that a
    # wearer without a link can have reached, walls considered; empty: only the ellipse is known
    floor_down_m: float | None = None  # of the floor, as planned or learnt; None: not known


class AlarmParametersView(Answer, frozen=True, omit_defaults=True):
    """Amounts and names in the sentence of an alarm; what is not in it is left out."""

    member: str | None = None  # its wearer, or the unit where it is not worn
    member_before: str | None = None  # the former wearer, where it may concern that person
    unit_id: str | None = None
    duration_s: float | None = None
    temperature_degc: float | None = None  # of the air around the equipment
    heat_fraction: float | None = None  # used part of the equipment's heat limit; 1: all of it
    battery_fraction: float | None = None
    radius_m: float | None = None  # that holds the member with 95 % probability
    reasons: tuple[str, ...] = ()  # why an estimate is poor, or a fix is not used; codes
    fault: str | None = None  # text of the unit, its agent or the station
    part: str | None = None  # of the station, that fails
    calibrated_s: int | None = None  # UTC seconds
    fault_code: str | None = None  # of the sentence in ``fault``, where it has one
    fault_texts: dict[str, str] = msgspec.field(
        default_factory=dict
    )  # parameters of ``fault_code``, by name
    fault_numbers: dict[str, float] = msgspec.field(default_factory=dict)


class AlarmView(Answer, frozen=True):
    alarm_id: str
    rule: str
    unit_id: str
    priority: int
    state: str  # raised | acknowledged | resolved
    level: str
    text: str
    by: str
    raised_ms: int
    last_raised_ms: int  # at first, or anew: it got worse, or happened again
    changed_ms: int
    code: str = ""  # of the sentence; empty: recorded by an earlier version, there is only the text
    parameters: AlarmParametersView = AlarmParametersView()
    reason: str = ""  # code of the reason for which a user resolved it; empty: none was given
    note: str = ""  # the user's note
    peak: float | None = None  # worst measured value of the rule until changed_ms


class DutyView(Answer, frozen=True):
    """While an incident is open: how the member's PAR stands, and work and rest."""

    checked_in_ms: int | None  # at the last PAR confirmation; None: not yet confirmed
    checked_in_by: str  # self: the member; radio: who entered it; empty: not yet confirmed
    due_ms: int  # of the next PAR
    asked_ms: int | None  # a PAR was requested, and is not answered
    work_since_ms: int | None
    rest_since_ms: int | None
    rest_due_ms: int | None
    confirmed: Annotated[str, one_of("self", "radio", "not_yet")]  # self: by the member's own unit
    on_duty_ms: int  # since when
    located: bool  # a message of the unit has come in this incident
    entry_id: str  # by which a confirmation by radio can be undone; empty: there is none, or no id


class TrustView(Answer, frozen=True):
    """Trust in the place of a unit, as a light."""

    level: Annotated[str, one_of("green", "amber", "red")]
    reason: str  # for a person; empty: green


class PreflightView(Answer, frozen=True):
    """Findings of a unit's self-check at its start."""

    level: Annotated[str, one_of("ok", "warning", "failed")]
    text: str  # for a person, the gravest first; empty: ok


class WornSensorView(Answer, frozen=True):
    """Inertial sensor of a unit, and where its wearer has it."""

    name: str  # in the unit; empty: its only one
    place: str  # part of the body, such as left_foot; empty: unknown
    place_recognised: bool  # by its motion; else the place is that of the unit's settings
    mount: str  # way of fastening, in words
    model: str


class ClockView(Answer, frozen=True):
    """A unit's estimate of the station's time."""

    ahead_ms: float  # the unit's own UTC less the station's
    std_ms: float


class PinView(Answer, frozen=True):
    """Place of a wearer that a person or a beacon has reported, with the verdict on it."""

    pin_id: str
    kind: Annotated[str, one_of("place", "start", "meeting", "beacon", "tag")]
    unit_id: str
    other_id: str  # the beacon or tag, or the other unit of a meeting; else empty
    t_ms: int  # 0: where the unit's path begins
    north_m: float | None  # None: a meeting, or a beacon that is not placed yet
    east_m: float | None
    floor: int | None
    std_m: float
    heading_rad: float | None
    heading_std_rad: float
    note: str
    by: str  # the user who set it; the unit itself for a sighting
    set_ms: int
    state: Annotated[str, one_of("used", "conflict", "waiting")]
    residual_m: float | None  # between the pin and the trail
    sigmas: float | None  # the same in standard deviations of the expectation
    text: str  # for a person: what it conflicts with, or what it waits for


class BeaconView(Answer, frozen=True):
    """A beacon or tag that hangs at a known place."""

    beacon_id: str
    label: str
    north_m: float
    east_m: float
    floor: int | None
    std_m: float
    reach_m: float
    seen_ms: int | None  # when a unit last saw it
    site_id: str = ""  # on which site it hangs


class ExternalMarkerView(Answer, frozen=True):
    """A person or marker of another team, from another system."""

    marker_id: str
    source: str  # name of the forwarder
    name: str
    kind: Annotated[str, one_of("person", "marker", "emergency")]
    remarks: str
    north_m: float
    east_m: float
    radius_m: float | None  # of the region in which it is; None: unknown
    t_ms: int  # the time to which the place belongs
    stale_ms: int  # from then on it is old
    site_id: str = ""  # incident whose frame its place uses: a marker is shown on each site


class UnitView(Answer, frozen=True):
    """Everything a card and the plan show of one unit; a delta carries it whole."""

    unit_id: str
    label: str
    registered: bool
    person: PersonView | None
    link: Link
    last_heard_ms: int | None
    status: StatusView | None
    status_ms: int | None  # age of the status is shown too
    ambient_degc: float | None
    heat_level: str  # "" | caution | warning | critical
    heat_used: float  # part of the equipment's heat budget, in this incident
    position: PositionView | None
    inside_since_ms: int | None
    duty: DutyView | None  # None: it is not worn, or no incident is open
    alarms: tuple[str, ...]  # ids of the alarms that are not resolved
    trust: TrustView
    clock: ClockView | None  # None: it has not received the station's time yet
    cloned: bool  # two machines speak under its name; one of them is shown
    gps: str | None  # why its last fix is not used; empty: it is; None: none has come
    switched_off: bool  # in order: its silence since is no loss
    ambient_ms: int | None  # when the temperature around the equipment came
    ambient_sensors: tuple[SensorTemperatureView, ...]  # its readings by name; empty: one sensor
    can_be_notified: bool | None  # it has an output for its wearer; None: not known yet
    preflight: PreflightView | None  # None: it has not checked itself yet
    tracker: str = ""  # that makes its positions of the samples; empty: not known yet
    sensors: tuple[WornSensorView, ...] = ()  # inertial ones; empty: not known yet
    # In which it is, or was when that was closed; empty: unassigned; None: in a recording of an
    # earlier version, where there was one incident.
    incident_id: str | None = None


class DeliveryView(Answer, frozen=True):
    """Progress of a command with one unit."""

    unit_id: str
    state: Annotated[
        str,
        one_of("queued", "sent", "received", "notified", "acknowledged", "refused", "expired"),
    ]
    sent_ms: int | None
    received_ms: int | None
    notified_ms: int | None  # an output of the unit has notified the wearer
    acknowledged_ms: int | None
    acknowledged_by: str  # self: the member; radio: who entered it
    reason: str  # of a refusal, or of a withdrawal
    # self: on the member's own unit; empty: not yet
    acknowledged_via: Annotated[str, one_of("self", "radio", "")]
    can_be_notified: bool | None  # as known at the last event; None: not known yet
    repeated_ms: int | None = None  # when the order was sent again last
    ended_ms: int | None = None  # the unit has answered that it knows that the order is over
    # Of a LOCATE: how the unit signals its place; empty: not known.
    signal: Annotated[str, one_of("sound", "light", "")] = ""


class CommandView(Answer, frozen=True):
    """A command to units; a delta carries it whole."""

    command_id: str
    kind: str  # lower-case name of shared.messages.CommandKind
    text: str
    issued_by: str
    issued_ms: int
    expires_ms: int
    asks_wearer: bool  # done only when the wearer has acknowledged it
    notifies_wearer: bool  # an output of each unit that has one is to notify its wearer
    open: bool  # open for further answers
    units: tuple[DeliveryView, ...]
    incident_id: str  # that was open when it was given; empty: none was
    ended_ms: int | None = None  # all clear, stopped, or its incident closed; None: it stands
    ended_command_id: str = ""  # of an all clear: the evacuation that it has ended


class DispatchView(Answer, frozen=True):
    """Newest report of the dispatch centre about an incident."""

    number: str
    source: str  # eido | json
    type: str  # of the incident, in words
    type_code: str
    priority: str
    address: str
    lat_deg: float | None
    lon_deg: float | None
    units: tuple[str, ...]  # call signs
    called_ms: int | None
    dispatched_ms: int | None
    updated_ms: int | None
    remarks: str
    has_ended: bool
    warnings: tuple[str, ...]  # about parts that were left out
    received_ms: int | None = None  # None: it has opened an incident
    is_dismissed: bool = False


class IncidentView(Answer, frozen=True):
    incident_id: str
    name: str
    opened_ms: int
    closed_ms: int | None
    par_interval_s: float  # each member is to be confirmed this often
    par_warning_s: float  # how long before it is due a check-in is announced
    work_limit_s: float
    dispatch: DispatchView | None = None  # from which it was opened
    site_id: str = ""  # its ground: empty, the station's own


class StandbyView(Answer, frozen=True):
    """State of this station as one of two."""

    station: str  # its name
    role: str  # active | standby | waiting
    url: str  # where consoles find it
    other: str  # "" until the other one's first heartbeat
    other_role: str  # "" while it is not reachable
    other_url: str
    in_step: bool  # the standby has what the active station has


class RecordingView(Answer, frozen=True):
    """A unit's raw recording that was requested, on its way over the bus."""

    fetch_id: str
    unit_id: str
    state: str  # waiting | fetching | done | failed
    problem: str  # a sentence for a person
    done_bytes: int
    total_bytes: int  # 0: not known yet


class ForwarderView(Answer, frozen=True):
    """A live connection with another system, such as a TAK server."""

    name: str  # as in the settings
    kind: str  # tak
    address: str
    state: Annotated[str, one_of("connected", "connecting", "standby")]  # standby: the other of
    # two stations forwards
    since_ms: int | None  # of that state; None: since the station started
    sent: int  # events since the station started
    received: int  # of other teams, since then
    refused: int  # of other teams, that could not be read or were too many
    text: str  # for a person: why it is not connected, or why less is sent; empty: all is well


class RadioView(Answer, frozen=True):
    """A radio channel whose audio is recorded."""

    name: str  # as in the settings
    source: str  # device:NAME or a URL, without a password
    state: Annotated[str, one_of("recording", "away")]
    problem: str  # a sentence for a person; empty: it is recorded


class ArchiveView(Answer, frozen=True):
    """The archive to which the station copies closed incidents by itself."""

    location: str  # a folder, or s3://BUCKET/PLACE
    state: Annotated[str, one_of("waiting", "copying", "away")]
    waiting: int  # closed incidents that are not there yet
    copied: int  # since the station started
    archived_ms: int | None  # when the last one was; null: none since the station started
    text: str  # for a person: why nothing can be copied; empty: all is well


class TextCodeView(Answer, frozen=True):
    """Code and parameters of a sentence, from which a console makes it in its own language."""

    code: str  # empty: there is the sentence alone
    texts: dict[str, str]  # parameters, by name
    numbers: dict[str, float]  # with their units in their names


class HealthView(Answer, frozen=True):
    """The station's own state; ``problems`` are sentences for a person."""

    problems: tuple[str, ...]
    messages: int
    undecodable: int
    unknown_units: int
    log_bytes: int
    disk_free_bytes: int
    messages_per_s: float
    insecure: bool
    standby: StandbyView | None = None  # None: this is the only station
    recordings: tuple[RecordingView, ...] = ()
    repeated: int = 0  # messages since the station started that came again and were kept once
    left_out: int = 0  # since then, as they came faster than this machine takes them
    missing: int = 0  # since then, numbers of messages that no unit's journal has any more
    forwarders: tuple[ForwarderView, ...] = ()  # live connections with other systems
    radio: tuple[RadioView, ...] = ()  # channels whose audio is recorded
    archive: ArchiveView | None = None  # None: incidents are archived by a command alone
    reading: float | None = None  # share of its log; the last stored state is shown
    problem_codes: tuple[TextCodeView, ...] = ()  # of ``problems``, in their order


class GapView(Answer, frozen=True):
    """Of this time the record has nothing."""

    from_ms: int
    until_ms: int


class ReplayView(Answer, frozen=True):
    """State of a replay; absent when the console shows the live picture."""

    incident_id: str
    start_ms: int
    end_ms: int
    at_ms: int
    speed: float
    playing: bool
    seeking: bool = False  # on the way to ``at_ms``; the shown state is of another time
    flaws: tuple[str, ...] = ()  # reason why parts are not shown as recorded, in words
    gap: GapView | None = None  # around its time: the shown state is of before


class TrailPoint(msgspec.Struct, frozen=True, array_like=True):
    """One point of a trail, at most one a second: ``[t_ms, north_m, east_m, floor]``, and behind a
    gap a fifth element, 1.  Of older points those that lie on one line are left out.
    """

    t_ms: int
    north_m: float
    east_m: float
    floor: int | None
    after_gap: Annotated[int, shown_as("0 | 1", {"enum": [0, 1]})] = (
        0  # 1: the way from the point before is unknown
    )


def encoded_trail(points: Iterable[TrailPoint]) -> bytes:
    """Without the fifth element where there is no gap: trails are most of what is sent."""
    rows = [
        (one.t_ms, one.north_m, one.east_m, one.floor, *([1] if one.after_gap else []))
        for one in points
    ]
    return msgspec.json.encode(rows)


class AnchorView(Answer, frozen=True):
    lat_deg: float
    lon_deg: float
    height_m: float
    plan_rotation_rad: float


class SiteView(Answer, frozen=True):
    """Ground of an incident beside the one of ``Snapshot.incident``."""

    site_id: str
    plan: Annotated[msgspec.Raw, shown_as("Plan | null", {"type": ["object", "null"]})]
    anchor: AnchorView | None
    plan_placed: bool


class Snapshot(msgspec.Struct, frozen=True, tag="snapshot"):
    seq: int
    now_ms: int
    incident: IncidentView | None
    units: tuple[UnitView, ...]
    alarms: tuple[AlarmView, ...]  # all that are not resolved, and the last resolved ones
    commands: tuple[CommandView, ...]  # all that are open, and the last closed ones; oldest first
    pins: tuple[PinView, ...]  # in the order of setting
    beacons: tuple[BeaconView, ...]
    external: tuple[ExternalMarkerView, ...]  # of other teams, where the site has an anchor
    # GeoJSON as stored: see docs/messages
    plan: Annotated[msgspec.Raw, shown_as("Plan", {"type": "object"})] | None
    anchor: AnchorView | None
    health: HealthView
    replay: ReplayView | None
    # All that are open, and closed ones until the next is opened on their site.
    incidents: tuple[IncidentView, ...] = ()
    sites: tuple[SiteView, ...] = ()  # beside the one of ``incident``
    plan_placed: bool = True  # False: the plan is not placed on the Earth yet
    dispatches: tuple[DispatchView, ...] = ()  # from which no incident was opened, oldest first


class Trail(msgspec.Struct, frozen=True, tag="trail"):
    """Trail of a unit before the last snapshot; deltas since then have gone on from there."""

    unit_id: str
    points: Annotated[msgspec.Raw, _POINTS]


class _WhatChanges(msgspec.Struct, frozen=True, omit_defaults=True, kw_only=True):
    """Fields that ``Delta`` and ``FieldDelta`` have in common."""

    alarms: tuple[AlarmView, ...] = ()
    commands: tuple[CommandView, ...] = ()
    trails: Mapping[str, Annotated[msgspec.Raw, _POINTS]] = {}  # of units whose past changed
    pins: tuple[PinView, ...] | None = None  # all of them, where any changed
    beacons: tuple[BeaconView, ...] | None = None
    external: tuple[ExternalMarkerView, ...] | None = None  # all of them, where any changed
    health: HealthView | None = None
    incident: IncidentView | None = None
    replay: ReplayView | None = None


class Delta(_WhatChanges, frozen=True, tag="delta", omit_defaults=True):
    seq: int
    now_ms: int
    units: tuple[UnitView, ...] = ()


# The fields of a ``UnitView`` that changed, all of them for a unit that is new.  Where such a field
# is an object and was one before, it has the fields of that which changed: as in a merge patch of
# JSON (RFC 7396), but null is a value.  Of a position, time and place always come together.
UnitChange = dict[str, object]


class FieldDelta(_WhatChanges, frozen=True, tag="field_delta", omit_defaults=True):
    """Changes since the message with ``after_seq``."""

    seq: int
    after_seq: int
    now_ms: int
    units: dict[
        str, Annotated[UnitChange, shown_as("UnitChange", {"type": "object"})]
    ] = {}  # by unit
    passed: Mapping[str, tuple[TrailPoint, ...]] = {}  # by unit: where it was between the two, at
    # most once a second; only where several messages were merged
