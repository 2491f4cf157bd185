"""Stored snapshot, for consoles while a starting station is still reading its log.

Reading a log without a saved state takes minutes.  Meanwhile a commander needs the last positions
of members, with their times, and the alarms; the tables have them.  Nothing in it is live: every
unit counts as not linked, and no change is possible.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from concurrent.futures import Future

import msgspec

from base_station.core.state.trail import TRAIL_GAP_NS
from base_station.engine.ports import ActionResult, LiveSink, Trails
from base_station.site.max_travel import RADII_95, max_travel_m
from base_station.site.plan import salvage_plan
from base_station.storage.db import models
from base_station.storage.db.records import Records, TrackSample
from base_station.storage.db.roster import Roster
from base_station.storage.db.window import FOREVER_NS, Window
from base_station.views.answer import to_ms, to_ms_or_none
from base_station.views.station import alarm_view, anchor_view
from base_station.views.stored_units import stored_sensors
from base_station.views.text_code import text_code_views
from base_station.views.wire import (
    HealthView,
    IncidentView,
    PersonView,
    PositionView,
    Snapshot,
    StandbyView,
    TrailPoint,
    TrustView,
    UnitView,
    encoded_trail,
)
from shared.clock import NS_PER_S, Clock
from shared.coded_text import code_of_text, coded
from shared.errors import StoreError
from shared.log_on_change import LogOnChange
from shared.messages.station import Action

_RECENT_NS = 3600 * NS_PER_S  # of trails; alarms raised so long before an incident belong to it
_TRAIL_EVERY_S = 5
_PUBLISH_EVERY_NS = 2 * NS_PER_S
_log = logging.getLogger(__name__)
_STORED_REASON = coded("doubt-stored", "as it was last stored; the station is reading its log")
_STORED = TrustView("red", str(_STORED_REASON), text_code_views(code_of_text(_STORED_REASON)))


class StoredSnapshotSource:
    """``LiveSource`` of the snapshot, which is also an ``OperatorGate`` and a status that refuse
    actions with a reason.
    """

    def __init__(self, roster: Roster, records: Records, clock: Clock, sink: LiveSink) -> None:
        self._roster = roster
        self._records = records
        self._clock = clock
        self._sink = sink
        self._fraction = 0.0
        self._published_ns = 0
        self._stored: tuple[Snapshot, Trails] | None = None  # nothing new while the log is read
        self._fault_log = LogOnChange(_log, "what was last stored cannot be shown")

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        """Give the snapshot to one console.  Raises StoreError if the tables cannot be read."""
        deliver(*self.snapshot())

    def report_progress(self, fraction: float) -> None:
        """Show the fraction of the log that was read; continues even if the tables cannot be
        read.
        """
        self._fraction = fraction
        now_ns = self._clock.monotonic_ns()
        if now_ns - self._published_ns >= _PUBLISH_EVERY_NS:
            self._published_ns = now_ns
            with self._fault_log:
                self._sink.reset(*self.snapshot())

    # ---- a standing

    def view(self) -> StandbyView:
        return StandbyView("", "waiting", "", "", "", "", in_step=False)

    def refusal(self) -> str:
        return (
            f"the station is reading its log ({self._fraction:.0%}) and shows what was last stored"
        )

    def take_over(self) -> None:
        raise StoreError(self.refusal())

    def submit(self, _by: str, _action: Action, _action_id: str = "") -> Future[ActionResult]:
        refused: Future[ActionResult] = Future()
        refused.set_exception(StoreError(self.refusal()))
        return refused

    # ---- the picture

    def snapshot(self) -> tuple[Snapshot, Trails]:
        stored, trails = self._stored = self._stored or self._read()
        now_ms = to_ms(self._clock.utc_ns())
        shown = msgspec.structs.replace(
            stored,
            now_ms=now_ms,
            units=tuple(_grown(unit, now_ms) for unit in stored.units),
            health=msgspec.structs.replace(stored.health, reading=self._fraction),
        )
        return shown, trails

    def _read(self) -> tuple[Snapshot, Trails]:
        now_ns = self._clock.utc_ns()
        incident = next((one for one in self._records.incidents() if one.closed_ns is None), None)
        since_ns = (now_ns if incident is None else incident.opened_ns) - _RECENT_NS
        open_alarms = [
            one
            for one in self._records.alarms(Window(since_ns, FOREVER_NS))
            if one.state != "resolved"
        ]
        trails = {
            unit_id: self._trail(unit_id, now_ns - _RECENT_NS) or self._trail(unit_id, since_ns)
            for unit_id in self._roster.registered_units()
        }
        plan, anchor = self._records.plan(), self._records.anchor()
        shown = Snapshot(
            seq=0,
            now_ms=to_ms(now_ns),
            incident=None if incident is None else self._incident(incident),
            units=tuple(
                self._unit(unit, worn, trails.get(unit.unit_id, []), open_alarms)
                for unit, worn in self._roster.units()
            ),
            alarms=tuple(alarm_view(alarm, self._roster.known) for alarm in open_alarms),
            commands=(),
            pins=(),
            beacons=(),
            external=(),
            plan=None if plan is None else msgspec.Raw(salvage_plan(plan).geojson),
            anchor=None if anchor is None else anchor_view(anchor),
            health=HealthView((), 0, 0, 0, 0, 0, 0.0, insecure=False),
            replay=None,
        )
        return shown, {unit_id: _points(trail) for unit_id, trail in trails.items()}

    def _trail(self, unit_id: str, since_ns: int) -> list[TrackSample]:
        return self._records.track(unit_id, Window(since_ns, FOREVER_NS), _TRAIL_EVERY_S)

    def _unit(
        self,
        unit: models.Unit,
        worn: models.Assignment | None,
        trail: list[TrackSample],
        alarms: list[models.AlarmRow],
    ) -> UnitView:
        return UnitView(
            unit_id=unit.unit_id,
            label=self._roster.shown(unit.label),
            registered=unit.registered_ns is not None,
            person=None if worn is None else self._person(worn),
            link="lost" if unit.last_heard_ns is not None else "never",
            last_heard_ms=to_ms_or_none(unit.last_heard_ns),
            status=None,
            status_ms=None,
            ambient_degc=None,
            heat_level=next(
                (one.level for one in alarms if (one.unit_id, one.rule) == (unit.unit_id, "heat")),
                "",
            ),
            heat_used=0.0,
            position=_position(trail[-1]) if trail else None,
            inside_since_ms=None,
            duty=None,
            alarms=tuple(one.alarm_id for one in alarms if one.unit_id == unit.unit_id),
            trust=_STORED,
            clock=None,
            cloned=False,
            gps=None,
            switched_off=False,
            ambient_ms=None,
            ambient_sensors=(),
            can_be_notified=None,
            preflight=None,
            tracker=unit.tracker,
            sensors=stored_sensors(unit),
        )

    def _person(self, worn: models.Assignment) -> PersonView:
        shown = self._roster.wearer(worn)
        return PersonView(worn.person_id, *msgspec.structs.astuple(shown))

    def _incident(self, incident: models.IncidentRow) -> IncidentView:
        """Incident as it is stored; no PAR counts down while nothing is live."""
        name, opened_ms = self._roster.shown(incident.name), to_ms(incident.opened_ns)
        return IncidentView(incident.incident_id, name, opened_ms, None, 0.0, 0.0, 0.0)


def _position(sample: TrackSample) -> PositionView:
    """Position with the larger error on both axes, as the tables do not have more of the region."""
    radius_m = RADII_95 * max(sample.std_north_m, sample.std_east_m)
    return PositionView(
        t_ms=to_ms(sample.t_ns),
        north_m=sample.north_m,
        east_m=sample.east_m,
        down_m=sample.down_m,
        floor=sample.floor,
        ellipse_major_m=radius_m,
        ellipse_minor_m=radius_m,
        ellipse_heading_rad=0.0,
        std_down_m=sample.std_down_m,
        heading_rad=sample.heading_rad,
        heading_std_rad=math.pi,
        quality=sample.quality,
        quality_reason=_STORED.reason,
        since_gps_s=None,
        lat_deg=None,
        lon_deg=None,
        floor_probability=None,
        reach=(),
    )


def _grown(unit: UnitView, now_ms: int) -> UnitView:
    """Position with its region enlarged by the time since, as for every unit without a link."""
    position = unit.position
    if position is None:
        return unit
    radius_m = position.ellipse_major_m + max_travel_m((now_ms - position.t_ms) / 1000.0)
    grown = msgspec.structs.replace(position, ellipse_major_m=radius_m, ellipse_minor_m=radius_m)
    return msgspec.structs.replace(unit, position=grown)


def _points(trail: list[TrackSample]) -> msgspec.Raw:
    points = [
        TrailPoint(
            to_ms(one.t_ns),
            one.north_m,
            one.east_m,
            one.floor,
            int(one.t_ns - before.t_ns > TRAIL_GAP_NS),
        )
        for before, one in zip(trail[:1] + trail, trail, strict=False)
    ]
    return msgspec.Raw(encoded_trail(points))
