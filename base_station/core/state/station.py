"""State of the whole station: everything that the pipeline keeps from one event to the next."""

from __future__ import annotations

import msgspec

from base_station.core.state.alarm import Alarm
from base_station.core.state.command import SentCommand
from base_station.core.state.incident import Dispatch, Incident
from base_station.core.state.resolve_queue import PendingResolve
from base_station.core.state.site import OWN_SITE_ID, SiteState
from base_station.core.state.unit import UnitState
from base_station.fusion.odometry.path_history import PathHistory
from shared.channels import tracked_unit
from shared.coded_text import NO_CODE, TextCode, coded
from shared.errors import UserError
from shared.messages import STATION_ID, ExternalMarker, Header
from shared.messages.station import TakeOver


class IdempotencyRecord(msgspec.Struct, frozen=True):
    """Result of a request that its client may repeat (``idempotency``)."""

    action_id: str
    t_ns: int
    created_id: str  # of the command, pin or incident; empty: it made none
    refused: str  # why it had no effect; empty: it had
    refused_code: TextCode = NO_CODE  # of that text


class Counts(msgspec.Struct):
    messages: int = 0
    undecodable: int = 0
    last_undecodable: str = ""
    unregistered_dropped: int = 0  # messages of unregistered units beyond those that are kept


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
    # Open ones, and closed ones until the next is opened on their site; in the order of opening.
    incidents: dict[str, Incident] = msgspec.field(default_factory=dict)
    closed_incidents: list[Incident] = msgspec.field(default_factory=list)  # closed, oldest first
    sites: dict[str, SiteState] = msgspec.field(
        default_factory=lambda: {OWN_SITE_ID: SiteState()}
    )  # by id
    paths: dict[str, PathHistory] = msgspec.field(default_factory=dict)  # of units
    trust_ns: int = 0  # of the last update of the trust tallies
    late: dict[str, PendingResolve] = msgspec.field(
        default_factory=dict
    )  # pinned units: to be solved again
    thresholds: dict[str, float] = msgspec.field(default_factory=dict)  # of alarm rules
    fuser: str = ""  # name of the fuser of all units; empty: the usual one
    problems: dict[str, str] = msgspec.field(default_factory=dict)  # by part of the station
    problem_codes: dict[str, TextCode] = msgspec.field(default_factory=dict)  # of those, likewise
    idempotency_records: dict[str, IdempotencyRecord] = msgspec.field(
        default_factory=dict
    )  # by key, oldest first
    take_overs: list[TakeOver] = msgspec.field(default_factory=list)  # leaders so far
    external: dict[str, ExternalMarker] = msgspec.field(default_factory=dict)  # of other teams
    dispatches: tuple[Dispatch, ...] = ()  # from which no incident was opened, oldest first
    counts: Counts = msgspec.field(default_factory=Counts)

    def sender(self, unit_id: str) -> UnitState | None:
        """A unit, or the agent that tracks for one; None: no message of it has ever come."""
        unit = self.units.get(unit_id)
        if unit is not None:  # nearly always
            return unit
        unit = self.units.get(tracked_unit(unit_id) or unit_id)
        return None if unit is None else unit.tracker

    def registered_unit(self, unit_id: str) -> UnitState:
        """Registered unit of that id; UserError where there is none."""
        unit = self.units.get(unit_id)
        if unit is None or not unit.registered:
            raise UserError(
                coded(
                    "unit-not-registered",
                    "no registered unit {unit!r}; register it first",
                    unit=unit_id,
                )
            )
        return unit

    @property
    def open_incidents(self) -> list[Incident]:
        """Open incidents, in the order of opening."""
        return [incident for incident in self.incidents.values() if incident.is_open]

    @property
    def shown_incident(self) -> Incident | None:
        """Incident of consoles that show one: the one opened last, or else the one closed last."""
        opened = self.open_incidents
        if opened:
            return opened[-1]
        return max(self.incidents.values(), key=lambda one: one.closed_ns or 0, default=None)

    def incident_of(self, unit: UnitState) -> Incident | None:
        """Incident of a unit, which may be closed since; None: it is unassigned."""
        return self.incidents.get(unit.incident_id)

    def open_incident_of(self, unit: UnitState) -> Incident | None:
        """Open incident of a unit; None: it is in none."""
        incident = self.incidents.get(unit.incident_id)
        return incident if incident is not None and incident.is_open else None

    def named_incident(self, incident_id: str) -> Incident:
        """The open incident of that id; empty: the only open one.  UserError where there is none,
        or where several are.
        """
        opened = self.open_incidents
        if not incident_id and len(opened) > 1:
            names = ", ".join(repr(one.name) for one in opened)
            raise UserError(
                coded(
                    "incidents-several",
                    "several incidents are open ({incidents}); name one of them",
                    incidents=names,
                )
            )
        found = [one for one in opened if incident_id in ("", one.incident_id)]
        if not found:
            if not incident_id:
                raise UserError(coded("no-open-incident", "no incident is open"))
            raise UserError(
                coded("incident-not-open", "no open incident {incident}", incident=incident_id)
            )
        return found[0]

    def site_id_of(self, incident_id: str) -> str:
        """Site of an incident; of no incident the station's own.  UserError where it is unknown."""
        if not incident_id:
            return OWN_SITE_ID
        if incident_id not in self.incidents:
            raise UserError(
                coded(
                    "incident-gone",
                    "no incident {incident} is open, nor was closed last",
                    incident=incident_id,
                )
            )
        return self.incidents[incident_id].site_id

    @property
    def site(self) -> SiteState:
        """The station's own site."""
        return self.sites[OWN_SITE_ID]

    def site_of(self, unit_id: str) -> SiteState:
        """The site in whose frame a unit is; of an unknown one the station's own."""
        unit = self.units.get(unit_id)
        return self.sites[OWN_SITE_ID if unit is None else unit.site_id]

    def units_on(self, site_id: str) -> list[UnitState]:
        """Units whose path and position are in the frame of that site."""
        return [unit for unit in self.units.values() if unit.site_id == site_id]

    def paths_on(self, site_id: str) -> dict[str, PathHistory]:
        """Paths in the frame of that site, by unit."""
        paths = self.paths.items()
        return {one: path for one, path in paths if self.units[one].site_id == site_id}

    def add_unit(self, unit_id: str) -> UnitState:
        """A unit that comes while one incident is open is in that."""
        unit = self.units[unit_id] = UnitState(unit_id)
        opened = self.open_incidents
        if len(opened) == 1:
            unit.incident_id, unit.site_id = opened[0].incident_id, opened[0].site_id
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
