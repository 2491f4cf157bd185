"""The live state as the console sees it: ``base_station.api.wire``."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import msgspec

from base_station.accountability import warning_s
from base_station.api.wire import (
    AlarmView,
    AnchorView,
    BeaconView,
    ClockView,
    CommandView,
    DeliveryView,
    DutyView,
    HealthView,
    IncidentView,
    PersonView,
    PinView,
    PositionView,
    RecordingView,
    ReplayView,
    Snapshot,
    StandbyView,
    StatusView,
    TrailPoint,
    TrustView,
    UnitView,
)
from base_station.assessment.trust import trust_of
from base_station.commands.state import Delivery, SentCommand
from base_station.live.sinks import PhotoUrls
from base_station.live_state import (
    Alarm,
    Duty,
    Incident,
    Person,
    StationState,
    TrailStep,
    UnitState,
)
from base_station.pins.pin import WAITING, Pin
from base_station.site.plan import Ring
from base_station.site.roaming import RADII_95, roamed_m
from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.messages import Activity, AlarmChange, AlarmState, FusedPosition, Heartbeat, Status
from shared.quality import Quality

NS_PER_MS = 1_000_000
RESOLVED_SHOWN = 20
_ACTIVITY_WORDS = tuple(activity.name.lower() for activity in Activity)  # by number
_QUALITY_WORDS = tuple(quality.name.lower() for quality in Quality)


class StationFacts(msgspec.Struct, frozen=True):
    """What the drive knows of the station's surroundings, for health."""

    problems: tuple[str, ...] = ()  # beside those in the live state
    log_bytes: int = 0
    disk_free_bytes: int = 0
    messages_per_s: float = 0.0
    repeated: int = 0
    insecure: bool = False
    standby: StandbyView | None = None
    recordings: tuple[RecordingView, ...] = ()


def unit_views(
    state: StationState, units: Iterable[UnitState], photo_urls: PhotoUrls
) -> tuple[UnitView, ...]:
    """Units' cards and places."""
    open_alarms: dict[str, list[Alarm]] = {}
    for alarm in state.alarms.values():
        if alarm.state is not AlarmState.RESOLVED:
            open_alarms.setdefault(alarm.unit_id, []).append(alarm)
    return tuple(
        _unit_view(state, unit, photo_urls, open_alarms.get(unit.unit_id, ())) for unit in units
    )


def _unit_view(
    state: StationState, unit: UnitState, photo_urls: PhotoUrls, open_alarms: Sequence[Alarm]
) -> UnitView:
    status = unit.shown_status
    return UnitView(
        unit_id=unit.unit_id,
        label=unit.label,
        registered=unit.registered,
        person=person_view(unit.person, photo_urls) if unit.person else None,
        link=unit.link,
        last_heard_ms=_ms(unit.heard_ns),
        status=_status_view(unit, status) if status else None,
        status_ms=_ms(unit.status_ns) if unit.status else None,
        ambient_degc=unit.temperature.ambient_degc if unit.temperature else None,
        heat_level=next((alarm.level for alarm in open_alarms if alarm.rule == "heat"), ""),
        position=_position_view(state, unit.fused, unit.reach) if unit.fused else None,
        inside_since_ms=_ms(unit.inside_since_ns),
        duty=_duty_view(unit.duty) if unit.duty else None,
        alarms=tuple(alarm.alarm_id for alarm in open_alarms),
        trust=trust_view(state, unit),
        clock=_clock_view(unit.heartbeat),
        cloned=any(alarm.rule == "cloned-unit" for alarm in open_alarms),
    )


def _clock_view(heartbeat: Heartbeat | None) -> ClockView | None:
    if heartbeat is None or heartbeat.clock_std_s == 0.0:
        return None
    return ClockView(1e3 * heartbeat.clock_ahead_s, 1e3 * heartbeat.clock_std_s)


def trust_view(state: StationState, unit: UnitState) -> TrustView:
    trust = trust_of(state, unit)
    return TrustView(trust.level, trust.reason)


def person_view(person: Person, photo_urls: PhotoUrls) -> PersonView:
    return PersonView(
        person_id=person.person_id,
        name=person.name,
        crew=person.crew,
        role=person.role,
        photo_url=photo_urls(person.person_id),
    )


def alarm_view(alarm: Alarm | AlarmChange) -> AlarmView:
    changed_ns = alarm.changed_ns if isinstance(alarm, Alarm) else alarm.header.t_utc_ns
    return AlarmView(
        alarm_id=alarm.alarm_id,
        rule=alarm.rule,
        unit_id=alarm.unit_id,
        priority=alarm.priority,
        state=alarm.state.name.lower(),
        level=alarm.level,
        text=alarm.text,
        by=alarm.by,
        raised_ms=alarm.raised_ns // NS_PER_MS,
        changed_ms=changed_ns // NS_PER_MS,
    )


def command_view(command: SentCommand) -> CommandView:
    return CommandView(
        command_id=command.command_id,
        kind=command.kind.name.lower(),
        text=command.text,
        issued_by=command.issued_by,
        issued_ms=command.issued_ns // NS_PER_MS,
        expires_ms=command.expires_ns // NS_PER_MS,
        asks_wearer=command.asks_wearer,
        open=command.is_open,
        units=tuple(_delivery_view(command, one) for one in command.deliveries.values()),
    )


def _delivery_view(command: SentCommand, delivery: Delivery) -> DeliveryView:
    return DeliveryView(
        unit_id=delivery.unit_id,
        state=command.state_of(delivery),
        sent_ms=_ms(delivery.sent_ns),
        received_ms=_ms(delivery.received_ns),
        acknowledged_ms=_ms(delivery.acknowledged_ns),
        acknowledged_by=delivery.acknowledged_by,
        reason=delivery.reason,
    )


def incident_view(incident: Incident) -> IncidentView:
    return IncidentView(
        incident_id=incident.incident_id,
        name=incident.name,
        opened_ms=incident.opened_ns // NS_PER_MS,
        closed_ms=_ms(incident.closed_ns),
        par_interval_s=incident.par_interval_s,
        par_warning_s=warning_s(incident),
        work_limit_s=incident.work_limit_s,
    )


def _duty_view(duty: Duty) -> DutyView:
    return DutyView(
        checked_in_ms=duty.checked_in_ns // NS_PER_MS,
        checked_in_by=duty.checked_in_by,
        due_ms=duty.due_ns // NS_PER_MS,
        asked_ms=_ms(duty.asked_ns),
        work_since_ms=_ms(duty.work_since_ns),
        rest_since_ms=_ms(duty.rest_since_ns),
        rest_due_ms=_ms(duty.rest_due_ns),
    )


def pin_views(state: StationState) -> tuple[PinView, ...]:
    """All pins, in the order of setting."""
    return tuple(_pin_view(state, pin) for pin in state.pins.values())


def _pin_view(state: StationState, pin: Pin) -> PinView:
    verdict = state.pin_verdicts.get(pin.pin_id, WAITING)
    beacon = state.beacons.get(pin.other_id)
    seen_at = pin if pin.north_m is not None or beacon is None else beacon
    return PinView(
        pin_id=pin.pin_id,
        kind=pin.kind,
        unit_id=pin.unit_id,
        other_id=pin.other_id,
        t_ms=pin.t_ns // NS_PER_MS,
        north_m=seen_at.north_m,
        east_m=seen_at.east_m,
        floor=seen_at.floor,
        std_m=pin.std_m,
        heading_rad=pin.heading_rad,
        heading_std_rad=pin.heading_std_rad,
        note=pin.note,
        by=pin.by,
        set_ms=pin.set_ns // NS_PER_MS,
        state=verdict.state,
        residual_m=verdict.residual_m,
        sigmas=verdict.sigmas,
        text=verdict.text,
    )


def beacon_views(state: StationState) -> tuple[BeaconView, ...]:
    return tuple(
        BeaconView(
            beacon_id=beacon.beacon_id,
            label=beacon.label,
            north_m=beacon.north_m,
            east_m=beacon.east_m,
            floor=beacon.floor,
            std_m=beacon.std_m,
            reach_m=beacon.reach_m,
            seen_ms=_ms(beacon.seen_ns),
        )
        for beacon in state.beacons.values()
    )


def health_view(state: StationState, facts: StationFacts) -> HealthView:
    counts = state.counts
    problems = [*state.problems.values(), *facts.problems]
    if counts.undecodable:
        problems.append(
            f"{counts.undecodable} messages could not be read; last {counts.last_undecodable}"
        )
    if counts.units_left_out:
        problems.append(
            f"{counts.units_left_out} messages of more unregistered units than are shown"
        )
    return HealthView(
        problems=tuple(problems),
        messages=counts.messages,
        undecodable=counts.undecodable,
        unknown_units=sum(not unit.registered for unit in state.units.values()),
        log_bytes=facts.log_bytes,
        disk_free_bytes=facts.disk_free_bytes,
        messages_per_s=facts.messages_per_s,
        repeated=facts.repeated,
        insecure=facts.insecure,
        standby=facts.standby,
        recordings=facts.recordings,
    )


def snapshot(
    state: StationState,
    seq: int,
    facts: StationFacts,
    photo_urls: PhotoUrls,
    replay: ReplayView | None = None,
) -> Snapshot:
    """Everything that a console shows."""
    still_open = [alarm for alarm in state.alarms.values() if alarm.is_open]
    shown = [*still_open, *state.history[-RESOLVED_SHOWN:]]
    return Snapshot(
        seq=seq,
        now_ms=state.t_ns // NS_PER_MS,
        incident=incident_view(state.incident) if state.incident else None,
        units=unit_views(state, state.units.values(), photo_urls),
        alarms=tuple(map(alarm_view, shown)),
        commands=tuple(map(command_view, state.commands.values())),
        trails={
            unit.unit_id: trail_view(unit.trail) for unit in state.units.values() if unit.trail
        },
        pins=pin_views(state),
        beacons=beacon_views(state),
        plan=msgspec.Raw(state.plan.geojson) if state.plan else None,
        anchor=_anchor_view(state.anchor) if state.anchor else None,
        health=health_view(state, facts),
        replay=replay,
    )


def _status_view(unit: UnitState, status: Status) -> StatusView:
    return StatusView(
        activity=_ACTIVITY_WORDS[status.activity],
        motionless_s=status.motionless_s,
        battery=status.battery,
        mayday=status.mayday,
        steps=status.steps,
        distance_m=unit.position.distance_m if unit.position else 0.0,
    )


def _position_view(state: StationState, fused: FusedPosition, reach: Ring) -> PositionView:
    lat_deg = lon_deg = None
    if state.anchor is not None:
        lat_deg, lon_deg, _ = state.anchor.to_geodetic(fused.north_m, fused.east_m, fused.down_m)
    silent_m = roamed_m((state.t_ns - fused.t_meas_ns) / NS_PER_S)
    major_m, minor_m, heading_rad = _ellipse(fused)
    return PositionView(
        t_ms=fused.t_meas_ns // NS_PER_MS,
        north_m=fused.north_m,
        east_m=fused.east_m,
        down_m=fused.down_m,
        floor=fused.floor,
        ellipse_major_m=major_m + silent_m,
        ellipse_minor_m=minor_m + silent_m,
        ellipse_heading_rad=heading_rad,
        std_down_m=fused.std_down_m,
        heading_rad=fused.heading_rad,
        heading_std_rad=fused.heading_std_rad,
        quality=_QUALITY_WORDS[fused.quality],
        quality_reason=fused.quality_reason,
        since_gps_s=fused.since_gps_s,
        lat_deg=lat_deg,
        lon_deg=lon_deg,
        floor_probability=fused.floor_probability,
        reach=tuple((round(east_m, 1), round(north_m, 1)) for east_m, north_m in reach),
    )


def _ellipse(fused: FusedPosition) -> tuple[float, float, float]:
    """Semi-axes of the 95 % region and the heading of the major one, clockwise from north."""
    north_var, east_var = fused.std_north_m**2, fused.std_east_m**2
    product = fused.correlation_ne * fused.std_north_m * fused.std_east_m
    middle, half = (north_var + east_var) / 2.0, math.hypot((north_var - east_var) / 2.0, product)
    heading_rad = 0.5 * math.atan2(2.0 * product, north_var - east_var)
    major_m = RADII_95 * math.sqrt(middle + half)
    return major_m, RADII_95 * math.sqrt(max(middle - half, 0.0)), heading_rad


def trail_view(trail: Iterable[TrailStep]) -> tuple[TrailPoint, ...]:
    return tuple(
        TrailPoint(
            step.t_ns // NS_PER_MS, round(step.north_m, 2), round(step.east_m, 2), step.floor
        )
        for step in trail
    )


def _anchor_view(anchor: Anchor) -> AnchorView:
    return AnchorView(anchor.lat_deg, anchor.lon_deg, anchor.height_m, anchor.rotation_rad)


def _ms(t_ns: int | None) -> int | None:
    return None if t_ns is None else t_ns // NS_PER_MS
