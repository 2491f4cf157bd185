"""Units as consoles show them on cards and on the plan, in the structs of ``wire``."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache

import msgspec

from base_station.core.state import Alarm, Person, StationState, UnitState
from base_station.core.state.duty import Duty
from base_station.core.trust.trust import Trust, conflicts_of, trust_of
from base_station.core.units.worn_sensors import DescribedSensor, worn_sensors
from base_station.site.max_travel import RADII_95, max_travel_m
from base_station.site.plan import Ring
from base_station.site.storeys import storey_of
from base_station.storage.db.known_people import KnownPerson, PersonLookup, shown_text
from base_station.views.answer import to_ms, to_ms_or_none
from base_station.views.text_code import text_code_view, text_code_views
from base_station.views.wire import (
    ClockView,
    DutyView,
    PersonView,
    PositionView,
    PreflightView,
    SensorTemperatureView,
    StatusView,
    TrustView,
    UnitView,
    WornSensorView,
)
from shared.clock import NS_PER_MS, NS_PER_S
from shared.coded_text import code_of_text, coded, with_code
from shared.messages import (
    Activity,
    BatteryState,
    BodyPosture,
    FusedPosition,
    Heartbeat,
    Mobility,
    PreflightFinding,
    PreflightLevel,
    SensorTemperature,
    Status,
)
from shared.quality import Quality

_ACTIVITY_WORDS = tuple(activity.name.lower() for activity in Activity)  # by number
_BATTERY_WORDS = tuple(state.name.lower() for state in BatteryState)
_POSTURE_WORDS = tuple(posture.name.lower() for posture in BodyPosture)
_MOBILITY_WORDS = tuple(mobility.name.lower() for mobility in Mobility)
_QUALITY_WORDS = tuple(quality.name.lower() for quality in Quality)
_GREEN = TrustView("green", "")
# No finer than a console shows, as digits are most of a message: a millimetre, a twentieth of a
# degree, a millimetre on the Earth.
_DECIMALS = 3
_DEGREE_DECIMALS = 8
_READY = PreflightView("ok", "")


def unit_views(
    state: StationState, units: Iterable[UnitState], people: PersonLookup
) -> tuple[UnitView, ...]:
    open_alarms: dict[str, list[Alarm]] = {}
    for alarm in state.alarms.values():
        if alarm.is_open:
            open_alarms.setdefault(alarm.unit_id, []).append(alarm)
    conflicts = conflicts_of(state)
    return tuple(
        [
            _unit_view(
                state,
                unit,
                people,
                open_alarms.get(unit.unit_id, ()),
                conflicts.get(unit.unit_id, 0),
            )
            for unit in units
        ]
    )


def _unit_view(
    state: StationState,
    unit: UnitState,
    people: PersonLookup,
    open_alarms: Sequence[Alarm],
    conflicts: int,
) -> UnitView:
    status, place, heat = unit.shown_status, unit.place, unit.heat
    trust = trust_of(unit, conflicts)
    levels = {alarm.rule: alarm.level for alarm in open_alarms}
    return UnitView(  # by place: there are thousands a second
        unit.unit_id,
        shown_text(unit.label, people),
        unit.registered,
        person_view(unit.wearer.person, people) if unit.wearer.person else None,
        unit.link,
        to_ms_or_none(unit.last_message_ns),
        _status_view(unit, status) if status else None,
        to_ms_or_none(unit.shown_status_ns) if status else None,
        heat.temperature.ambient_degc if heat.temperature else None,
        levels.get("heat", ""),
        round(heat.dose, 2),
        _position_view(state, place.fused, place.reach) if place.fused else None,
        to_ms_or_none(place.inside_since_ns),
        _duty_view(state, unit, unit.duty, people) if unit.duty else None,
        tuple([alarm.alarm_id for alarm in open_alarms]),
        _trust_view(trust) if trust.reason else _GREEN,
        _clock_view(unit.heartbeat),
        "cloned-unit" in levels,
        unit.gps.reason if unit.gps else None,
        unit.stopped_ns is not None,
        to_ms_or_none(heat.temperature_ns) if heat.temperature else None,
        _sensors_view(heat.temperature.sensors) if heat.temperature else (),
        unit.can_be_notified,
        preflight_view(unit.description.preflight) if unit.description else None,
        unit.description.tracker if unit.description else "",
        worn_sensor_views(worn_sensors(unit.description)) if unit.description else (),
        unit.incident_id,
    )


def _trust_view(trust: Trust) -> TrustView:
    return TrustView(trust.level, str(trust.reason), text_code_views(code_of_text(trust.reason)))


@lru_cache(maxsize=1000)  # findings are mostly the same, and each change of a unit shows them
def preflight_view(findings: tuple[PreflightFinding, ...] | None) -> PreflightView | None:
    """Findings of the unit's self-check in one text; None if the unit has not checked itself."""
    if findings is None:
        return None
    if not findings:
        return _READY
    failed = any(one.level is PreflightLevel.FAILED for one in findings)
    texts = [_finding_text(one) for one in findings]
    return PreflightView(
        "failed" if failed else "warning",
        "; ".join(texts),
        tuple(map(str, texts)),
        tuple(text_code_view(code_of_text(one)) for one in texts),
    )


def _finding_text(finding: PreflightFinding) -> str:
    return coded(
        "check-finding",
        "{subject}: {text}",
        subject=with_code(finding.subject, finding.subject_code),
        text=with_code(finding.text, finding.text_code),
    )


@lru_cache(maxsize=1000)
def worn_sensor_views(sensors: tuple[DescribedSensor, ...]) -> tuple[WornSensorView, ...]:
    """Sensors of a unit as a console shows them."""
    return tuple(WornSensorView(*msgspec.structs.astuple(one)) for one in sensors)


def _clock_view(heartbeat: Heartbeat | None) -> ClockView | None:
    if heartbeat is None or heartbeat.clock_std_s == 0.0:
        return None
    return ClockView(1e3 * heartbeat.clock_ahead_s, 1e3 * heartbeat.clock_std_s)


def person_view(person: Person, people: PersonLookup) -> PersonView:
    """Person with the present name; a log of an earlier version has the name of its time."""
    known = people(person.person_id)
    shown: KnownPerson | Person = person if person.name else known
    return PersonView(
        person_id=person.person_id,
        name=shown.name,
        crew=shown.crew,
        role=shown.role,
        photo_url=known.photo_url,
    )


def _duty_view(state: StationState, unit: UnitState, duty: Duty, people: PersonLookup) -> DutyView:
    last = duty.confirmation
    incident = state.incident_of(unit)
    opened_ns = 0 if incident is None else incident.opened_ns
    return DutyView(
        checked_in_ms=None if last is None else to_ms(last.t_ns),
        checked_in_by="" if last is None else shown_text(last.by, people),
        due_ms=to_ms(duty.due_ns),
        asked_ms=to_ms_or_none(duty.open_request_ns),
        work_since_ms=to_ms_or_none(duty.work_since_ns),
        rest_since_ms=to_ms_or_none(duty.rest_since_ns),
        rest_due_ms=to_ms_or_none(duty.rest_due_ns),
        confirmed=duty.confirmed,
        on_duty_ms=to_ms(duty.since_ns),
        located=unit.last_message_ns is not None and unit.last_message_ns >= opened_ns,
        entry_id="" if last is None else last.entry_id,
    )


def _status_view(unit: UnitState, status: Status) -> StatusView:
    return StatusView(
        activity=_ACTIVITY_WORDS[status.activity],
        motionless_s=status.motionless_s,
        battery=status.battery,
        mayday=status.mayday,
        steps=status.steps,
        distance_m=unit.position.distance_m if unit.position else 0.0,
        battery_left_s=status.battery_left_s,
        battery_state=_BATTERY_WORDS[status.battery_state],
        electronics=_sensors_view(status.electronics),
        posture=_POSTURE_WORDS[status.posture],
        posture_confidence=status.posture_confidence,
        mobility=_MOBILITY_WORDS[status.mobility],
    )


def _sensors_view(sensors: Sequence[SensorTemperature]) -> tuple[SensorTemperatureView, ...]:
    if not sensors:  # mostly, and there are thousands a second
        return ()
    return tuple([SensorTemperatureView(one.name, one.temperature_degc) for one in sensors])


def _position_view(state: StationState, fused: FusedPosition, reach: Ring) -> PositionView:
    lat_deg = lon_deg = None
    site = state.site_of(fused.unit_id)
    anchor = site.anchor
    if anchor is not None:
        lat_deg, lon_deg, _ = anchor.to_geodetic(fused.north_m, fused.east_m, fused.down_m)
    silent_m = max_travel_m((state.t_ns - fused.t_meas_ns) / NS_PER_S)
    major_m, minor_m, heading_rad = _ellipse(fused)
    since_gps_s, probability = fused.since_gps_s, fused.floor_probability
    storey = storey_of(site.storeys_at(fused.north_m, fused.east_m), fused.floor)
    return PositionView(  # by place: there are thousands a second
        fused.t_meas_ns // NS_PER_MS,
        round(fused.north_m, _DECIMALS),
        round(fused.east_m, _DECIMALS),
        round(fused.down_m, _DECIMALS),
        fused.floor,
        round(major_m + silent_m, _DECIMALS),
        round(minor_m + silent_m, _DECIMALS),
        round(heading_rad, _DECIMALS),
        round(fused.std_down_m, _DECIMALS),
        round(fused.heading_rad, _DECIMALS),
        round(fused.heading_std_rad, _DECIMALS),
        _QUALITY_WORDS[fused.quality],
        fused.quality_reason,
        None if since_gps_s is None else round(since_gps_s, _DECIMALS),
        None if lat_deg is None else round(lat_deg, _DEGREE_DECIMALS),
        None if lon_deg is None else round(lon_deg, _DEGREE_DECIMALS),
        None if probability is None else round(probability, _DECIMALS),
        tuple([(round(east_m, 1), round(north_m, 1)) for east_m, north_m in reach]),
        None if storey is None else round(storey.down_m, 1),
    )


def _ellipse(fused: FusedPosition) -> tuple[float, float, float]:
    """Semi-axes of the 95 % region and the heading of the major one, clockwise from north."""
    north_var, east_var = fused.std_north_m**2, fused.std_east_m**2
    product = fused.correlation_ne * fused.std_north_m * fused.std_east_m
    middle, half = (north_var + east_var) / 2.0, math.hypot((north_var - east_var) / 2.0, product)
    heading_rad = 0.5 * math.atan2(2.0 * product, north_var - east_var)
    major_m = RADII_95 * math.sqrt(middle + half)
    return major_m, RADII_95 * math.sqrt(max(middle - half, 0.0)), heading_rad
