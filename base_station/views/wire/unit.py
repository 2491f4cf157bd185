"""Views of a unit, its wearer, its position and its sensors."""

from __future__ import annotations

from typing import Annotated, Literal

from base_station.views.answer import Answer
from base_station.views.wire.schema import one_of
from base_station.views.wire.text_code import TextCodeView

Link = Literal["live", "stale", "lost", "never"]


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


class DutyView(Answer, frozen=True):
    """State of the member's PAR, work and rest while an incident is open."""

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
    """Trust in the position of a unit, as a traffic light."""

    level: Annotated[str, one_of("green", "amber", "red")]
    reason: str  # for a person; empty: green
    # Of ``reason``: one, or none.  Lists go whole in a change, and their parameters differ.
    reason_codes: tuple[TextCodeView, ...] = ()


class PreflightView(Answer, frozen=True):
    """Findings of the self-check that a unit makes at its start."""

    level: Annotated[str, one_of("ok", "warning", "failed")]
    text: str  # for a person, the gravest first; empty: ok
    findings: tuple[str, ...] = ()  # which ``text`` joins
    finding_codes: tuple[TextCodeView, ...] = ()  # of ``findings``, in their order


class WornSensorView(Answer, frozen=True):
    """Inertial sensor of a unit, and where it is worn."""

    name: str  # in the unit; empty: its only one
    place: str  # part of the body, such as left_foot; empty: unknown
    place_recognised: bool  # by its motion; else the place is that of the unit's settings
    mount: str  # way of fastening, in words
    model: str


class ClockView(Answer, frozen=True):
    """A unit's estimate of the station's time."""

    ahead_ms: float  # the unit's own UTC less the station's
    std_ms: float


class UnitView(Answer, frozen=True):
    """State of one unit on its card and on the plan; a delta carries it whole."""

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
