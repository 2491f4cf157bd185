"""State of the whole station: everything that the pipeline keeps from one event to the next."""

from __future__ import annotations

import msgspec

from base_station.core.state.alarm import Alarm
from base_station.core.state.command import SentCommand
from base_station.core.state.incident import Dispatch, Incident
from base_station.core.state.pin import Beacon, Pin, PinVerdict
from base_station.core.state.resolve_queue import PendingResolve
from base_station.core.state.unit import UnitState
from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.gnss.common_mode_error import CommonModeError
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.vertical.weather import Barometers
from base_station.site.learnt_floors import LearntFloors
from base_station.site.plan import Plan
from base_station.site.storeys import Storey
from shared.channels import tracked_unit
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages import STATION_ID, ExternalMarker, Header
from shared.messages.station import TakeOver


class IdempotencyRecord(msgspec.Struct, frozen=True):
    """Result of a request that its client may repeat (``idempotency``)."""

    action_id: str
    t_ns: int
    created_id: str  # of the command, pin or incident; empty: it made none
    refused: str  # why it had no effect; empty: it had


class Counts(msgspec.Struct):
    messages: int = 0
    undecodable: int = 0
    last_undecodable: str = ""
    unregistered_dropped: int = 0  # messages of strangers beyond what is kept


class StationState(msgspec.Struct):
    """Everything the pipeline remembers from one event to the next."""

    t_ns: int = 0  # station time of the last event
    boot_id: int = 0  # station time of the first event: names this run of the pipeline
    seq: int = 0  # of the last output
    units: dict[str, UnitState] = msgspec.field(default_factory=dict)
    # The newest of each rule and unit; beside it those that are open of another wearer or fault.
    alarms: dict[str, Alarm] = msgspec.field(default_factory=dict)
    history: list[Alarm] = msgspec.field(default_factory=list)  # resolved lately
    commands: dict[str, SentCommand] = msgspec.field(default_factory=dict)  # oldest first
    incident: Incident | None = None
    closed_incidents: list[Incident] = msgspec.field(default_factory=list)  # closed, oldest first
    plan: Plan | None = None
    anchor: Anchor | None = None
    anchor_by_gps: bool = False  # nobody said where the frame lies; the first good fix did
    fixes_anchor: Anchor | None = None  # as it was when a fix was taken last
    far_fixes: int = 0  # in a row, too far from there to be of this site
    common_mode_error: CommonModeError = msgspec.field(default_factory=CommonModeError)
    barometers: Barometers = msgspec.field(default_factory=Barometers)
    start_set: bool = False  # somebody said where a unit began
    paths: dict[str, PathHistory] = msgspec.field(default_factory=dict)  # of units
    pins: dict[str, Pin] = msgspec.field(default_factory=dict)  # in the order of setting
    pin_verdicts: dict[str, PinVerdict] = msgspec.field(default_factory=dict)
    beacons: dict[str, Beacon] = msgspec.field(default_factory=dict)
    trust_ns: int = 0  # when lights were last looked at
    sighting_solved_ns: int = 0  # when a sighting was last solved at once
    late: dict[str, PendingResolve] = msgspec.field(
        default_factory=dict
    )  # pinned units: to be solved again
    learnt_building: LearntBuilding = LearntBuilding()
    learnt_floors: LearntFloors = msgspec.field(default_factory=LearntFloors)
    thresholds: dict[str, float] = msgspec.field(default_factory=dict)  # of alarm rules
    problems: dict[str, str] = msgspec.field(default_factory=dict)  # by part of the station
    idempotency_records: dict[str, IdempotencyRecord] = msgspec.field(
        default_factory=dict
    )  # by key, oldest first
    take_overs: list[TakeOver] = msgspec.field(default_factory=list)  # who has been in charge
    external: dict[str, ExternalMarker] = msgspec.field(default_factory=dict)  # of other teams
    dispatches: tuple[Dispatch, ...] = ()  # from which no incident was opened, oldest first
    counts: Counts = msgspec.field(default_factory=Counts)

    def sender(self, unit_id: str) -> UnitState | None:
        """A unit, or the agent that tracks for one; None: it was never heard."""
        unit = self.units.get(unit_id)
        if unit is not None:  # nearly always
            return unit
        unit = self.units.get(tracked_unit(unit_id) or unit_id)
        return None if unit is None else unit.tracker

    def registered_unit(self, unit_id: str) -> UnitState:
        """Registered unit of that id; UserError where there is none."""
        unit = self.units.get(unit_id)
        if unit is None or not unit.registered:
            raise UserError(f"no registered unit {unit_id!r}; register it first")
        return unit

    def path_of(self, unit_id: str) -> PathHistory:
        """Path of a unit, which begins here where there is none."""
        history = self.paths.get(unit_id)
        if history is None:
            history = self.paths[unit_id] = PathHistory()
        return history

    def next_header(self) -> Header:
        """Header of the next output."""
        self.seq += 1
        return Header(STATION_ID, self.boot_id, self.seq, self.t_ns, t_utc_ns=self.t_ns)

    @property
    def placed_plan(self) -> Plan | None:
        """The plan, unless nobody knows where on it people are: they are where the first fix put
        the frame, before there was any.
        """
        return None if self.anchor_by_gps else self.plan

    def storeys_at(self, north_m: float, east_m: float) -> tuple[Storey, ...]:
        """Storeys of the building there, lowest first: the plan's, or else the learnt ones."""
        if self.plan is not None and self.plan.storeys:
            return self.plan.storeys
        return self.learnt_floors.storeys_at(north_m, east_m)
