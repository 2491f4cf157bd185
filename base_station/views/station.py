"""The live state as consoles show it, in the structs of ``wire``. Units are in ``units``."""

from __future__ import annotations

import msgspec

from base_station.core.accountability import warning_s
from base_station.core.pins.evidence import location_of
from base_station.core.state import OWN_SITE_ID, Alarm, Dispatch, Incident, SiteState, StationState
from base_station.core.state.command import Delivery, SentCommand
from base_station.core.state.pin import WAITING, Pin
from base_station.core.units.unkept_messages import unkept_problem
from base_station.storage.db.known_people import PersonLookup, shown_text
from base_station.storage.db.models import AlarmRow as StoredAlarm
from base_station.views.alarm_parameters import parameters_view, stored_parameters_view
from base_station.views.answer import to_ms, to_ms_or_none
from base_station.views.text_code import text_code_view, text_code_view_or_none
from base_station.views.units import unit_views
from base_station.views.wire import (
    AlarmView,
    AnchorView,
    ArchiveView,
    BeaconView,
    CommandView,
    DeliveryView,
    DispatchView,
    ExternalMarkerView,
    ForwarderView,
    HealthView,
    IncidentView,
    PinView,
    RadioView,
    RecordingView,
    ReplayView,
    SiteView,
    Snapshot,
    StandbyView,
)
from shared.coded_text import NO_CODE, code_of_text, coded, map_texts
from shared.geo import Anchor
from shared.messages import AlarmChange, ExternalKind, ExternalMarker
from shared.messages.station import NoteDispatch

RESOLVED_SHOWN = 20
_EXTERNAL_KINDS = {ExternalKind.PERSON: "person", ExternalKind.EMERGENCY: "emergency"}


class StationFacts(msgspec.Struct, frozen=True):
    """State of the station's parts outside of the live state, which the engine adds to the
    health.
    """

    problems: tuple[str, ...] = ()  # beside those in the live state
    log_bytes: int = 0
    disk_free_bytes: int = 0
    messages_per_s: float = 0.0
    repeated: int = 0
    left_out: int = 0
    missing: int = 0
    insecure: bool = False
    standby: StandbyView | None = None
    recordings: tuple[RecordingView, ...] = ()
    forwarders: tuple[ForwarderView, ...] = ()
    radio: tuple[RadioView, ...] = ()
    archive: ArchiveView | None = None


def alarm_view(alarm: Alarm | AlarmChange | StoredAlarm, people: PersonLookup) -> AlarmView:
    changed_ns = alarm.header.t_utc_ns if isinstance(alarm, AlarmChange) else alarm.changed_ns
    return AlarmView(
        alarm_id=alarm.alarm_id,
        rule=alarm.rule,
        unit_id=alarm.unit_id,
        priority=alarm.priority,
        state=alarm.state if isinstance(alarm, StoredAlarm) else alarm.state.name.lower(),
        level=alarm.level,
        text=shown_text(alarm.text, people),
        by=shown_text(alarm.by, people),
        raised_ms=to_ms(alarm.raised_ns),
        last_raised_ms=to_ms(alarm.last_raised_ns),
        changed_ms=to_ms(changed_ns),
        code=alarm.code,
        parameters=(
            stored_parameters_view(alarm.parameters, people)
            if isinstance(alarm, StoredAlarm)
            else parameters_view(alarm.parameters, people)
        ),
        reason=alarm.reason,
        note=shown_text(alarm.note, people),
        peak=alarm.peak,
    )


def command_view(command: SentCommand, people: PersonLookup) -> CommandView:
    return CommandView(
        command_id=command.command_id,
        kind=command.kind.name.lower(),
        text=shown_text(command.text, people),
        issued_by=command.issued_by,
        issued_ms=to_ms(command.issued_ns),
        expires_ms=to_ms(command.expires_ns),
        asks_wearer=command.asks_wearer,
        notifies_wearer=command.notifies_wearer,
        open=command.is_open,
        units=tuple(_delivery_view(command, one, people) for one in command.deliveries.values()),
        incident_id=command.incident_id,
        ended_ms=to_ms_or_none(command.ended_ns),
        ended_command_id=command.ended_command_id,
    )


def _delivery_view(command: SentCommand, delivery: Delivery, people: PersonLookup) -> DeliveryView:
    return DeliveryView(
        unit_id=delivery.unit_id,
        state=command.state_of(delivery),
        sent_ms=to_ms_or_none(delivery.sent_ns),
        received_ms=to_ms_or_none(delivery.received_ns),
        notified_ms=to_ms_or_none(delivery.notified_ns),
        acknowledged_ms=to_ms_or_none(delivery.acknowledged_ns),
        acknowledged_by=shown_text(delivery.acknowledged_by, people),
        reason=delivery.reason,
        acknowledged_via=delivery.acknowledged_via,
        can_be_notified=delivery.can_be_notified,
        repeated_ms=to_ms_or_none(delivery.repeated_ns),
        ended_ms=to_ms_or_none(delivery.ended_ns),
        signal=delivery.signal,
        reason_code=text_code_view_or_none(delivery.reason_code),
    )


def incident_view(incident: Incident, people: PersonLookup) -> IncidentView:
    return IncidentView(
        incident_id=incident.incident_id,
        name=shown_text(incident.name, people),
        opened_ms=to_ms(incident.opened_ns),
        closed_ms=to_ms_or_none(incident.closed_ns),
        par_interval_s=incident.par_interval_s,
        par_warning_s=warning_s(incident),
        work_limit_s=incident.work_limit_s,
        dispatch=dispatch_view(incident.dispatch, people) if incident.dispatch else None,
        site_id=incident.site_id,
    )


def dispatch_view(report: NoteDispatch, people: PersonLookup) -> DispatchView:
    times_ns = report.called_ns, report.dispatched_ns, report.updated_ns
    called_ms, dispatched_ms, updated_ms = (to_ms(t_ns) if t_ns else None for t_ns in times_ns)
    return DispatchView(
        number=report.number,
        source=report.source,
        type=report.type,
        type_code=report.type_code,
        priority=report.priority,
        address=report.address,
        lat_deg=report.lat_deg,
        lon_deg=report.lon_deg,
        units=report.units,
        called_ms=called_ms,
        dispatched_ms=dispatched_ms,
        updated_ms=updated_ms,
        remarks=shown_text(report.remarks, people),
        has_ended=report.has_ended,
        warnings=report.warnings,
        warning_codes=tuple(map(text_code_view, report.warning_codes)),
    )


def _offered_view(dispatch: Dispatch, people: PersonLookup) -> DispatchView:
    return msgspec.structs.replace(
        dispatch_view(dispatch.report, people),
        received_ms=to_ms(dispatch.received_ns),
        is_dismissed=dispatch.is_dismissed,
    )


def pin_views(state: StationState, people: PersonLookup) -> tuple[PinView, ...]:
    """Pins of all sites, those of each site in the order in which they were set."""
    return tuple(
        _pin_view(site, pin, people) for site in state.sites.values() for pin in site.pins.values()
    )


def _pin_view(site: SiteState, pin: Pin, people: PersonLookup) -> PinView:
    verdict = site.pin_verdicts.get(pin.pin_id, WAITING)
    at = location_of(site, pin)
    text = map_texts(verdict.coded_text, lambda one: shown_text(one, people))
    return PinView(
        pin_id=pin.pin_id,
        kind=pin.kind,
        unit_id=pin.unit_id,
        other_id=pin.other_id,
        t_ms=to_ms(pin.t_ns),
        north_m=at.north_m,
        east_m=at.east_m,
        floor=at.floor,
        std_m=pin.std_m,
        heading_rad=pin.heading_rad,
        heading_std_rad=pin.heading_std_rad,
        note=shown_text(pin.note, people),
        by=pin.by,
        set_ms=to_ms(pin.set_ns),
        state=verdict.state,
        residual_m=verdict.residual_m,
        sigmas=verdict.sigmas,
        text=str(text),
        text_code=text_code_view_or_none(code_of_text(text)),
    )


def beacon_views(state: StationState, people: PersonLookup) -> tuple[BeaconView, ...]:
    return tuple(
        BeaconView(
            beacon_id=beacon.beacon_id,
            label=shown_text(beacon.label, people),
            north_m=beacon.north_m,
            east_m=beacon.east_m,
            floor=beacon.floor,
            std_m=beacon.std_m,
            reach_m=beacon.reach_m,
            seen_ms=to_ms_or_none(beacon.seen_ns),
            site_id=site_id,
        )
        for site_id, site in state.sites.items()
        for beacon in site.beacons.values()
    )


def external_views(state: StationState) -> tuple[ExternalMarkerView, ...]:
    """Markers of other teams on the plan of each site; a site without an anchor has none, as their
    places on its plan are unknown.
    """
    anchors = ((site_id, site.anchor) for site_id, site in state.sites.items())
    return tuple(
        _external_view(site_id, anchor, marker)
        for site_id, anchor in anchors
        if anchor is not None
        for marker in state.external.values()
    )


def _external_view(site_id: str, anchor: Anchor, marker: ExternalMarker) -> ExternalMarkerView:
    north_m, east_m, _ = anchor.to_incident_m(marker.lat_deg, marker.lon_deg, anchor.height_m)
    return ExternalMarkerView(
        marker_id=marker.marker_id,
        source=marker.source,
        name=marker.name,
        kind=_EXTERNAL_KINDS.get(marker.kind, "marker"),
        remarks=marker.remarks,
        north_m=north_m,
        east_m=east_m,
        radius_m=marker.radius_m or None,
        t_ms=to_ms(marker.t_ns),
        stale_ms=to_ms(marker.stale_ns),
        site_id=site_id,
    )


def health_view(state: StationState, facts: StationFacts) -> HealthView:
    counts = state.counts
    problems = [*facts.problems]
    plans = [site.plan for site in state.sites.values() if site.plan is not None]
    problems += [plan.damage for plan in plans if plan.damage]
    if unkept := unkept_problem(state):
        problems.append(unkept)
    if counts.undecodable:
        problems.append(
            coded(
                "messages-unreadable",
                "{count} messages could not be read; last {last}",
                count=counts.undecodable,
                last=counts.last_undecodable,
            )
        )
    if counts.unregistered_dropped:
        problems.append(
            coded(
                "unregistered-messages",
                "{count} messages of more unregistered units than are shown",
                count=counts.unregistered_dropped,
            )
        )
    logged = state.problem_codes
    return HealthView(
        problems=(*state.problems.values(), *map(str, problems)),
        problem_codes=(
            *(text_code_view(logged.get(part, NO_CODE)) for part in state.problems),
            *(text_code_view(code_of_text(one)) for one in problems),
        ),
        messages=counts.messages,
        undecodable=counts.undecodable,
        unknown_units=sum(not unit.registered for unit in state.units.values()),
        log_bytes=facts.log_bytes,
        disk_free_bytes=facts.disk_free_bytes,
        messages_per_s=facts.messages_per_s,
        repeated=facts.repeated,
        left_out=facts.left_out,
        missing=facts.missing,
        insecure=facts.insecure,
        standby=facts.standby,
        recordings=facts.recordings,
        forwarders=facts.forwarders,
        radio=facts.radio,
        archive=facts.archive,
    )


def snapshot(
    state: StationState,
    seq: int,
    facts: StationFacts,
    people: PersonLookup,
    replay: ReplayView | None = None,
) -> Snapshot:
    """Everything that a console shows, except trails."""
    still_open = [alarm for alarm in state.alarms.values() if alarm.is_open]
    shown = [*still_open, *state.history[-RESOLVED_SHOWN:]]
    incident = state.shown_incident
    site_id = OWN_SITE_ID if incident is None else incident.site_id
    site = state.sites[site_id]
    return Snapshot(
        seq=seq,
        now_ms=to_ms(state.t_ns),
        incident=incident_view(incident, people) if incident else None,
        units=unit_views(state, state.units.values(), people),
        alarms=tuple(alarm_view(alarm, people) for alarm in shown),
        commands=tuple(command_view(command, people) for command in state.commands.values()),
        pins=pin_views(state, people),
        beacons=beacon_views(state, people),
        external=external_views(state),
        plan=msgspec.Raw(site.plan.geojson) if site.plan else None,
        anchor=anchor_view(site.anchor) if site.anchor else None,
        health=health_view(state, facts),
        replay=replay,
        plan_placed=site.plan is site.placed_plan,
        incidents=tuple(incident_view(one, people) for one in state.incidents.values()),
        sites=tuple(_site_view(one, it) for one, it in state.sites.items() if one != site_id),
        dispatches=tuple(_offered_view(one, people) for one in state.dispatches),
    )


def _site_view(site_id: str, site: SiteState) -> SiteView:
    return SiteView(
        site_id=site_id,
        plan=msgspec.Raw(site.plan.geojson if site.plan else b"null"),
        anchor=anchor_view(site.anchor) if site.anchor else None,
        plan_placed=site.plan is site.placed_plan,
    )


def anchor_view(anchor: Anchor) -> AnchorView:
    return AnchorView(anchor.lat_deg, anchor.lon_deg, anchor.height_m, anchor.rotation_rad)
