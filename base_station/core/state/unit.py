"""State of one unit: its wearer, link, readings, position, trail, alerts and duty."""

from __future__ import annotations

import msgspec

from base_station.core.person_references import reference_to
from base_station.core.state.boot_state import BootState
from base_station.core.state.duty import Duty
from base_station.core.state.exposure import ExposureInterval
from base_station.core.state.message_stream import STALE_AFTER_S, Link, MessageStream
from base_station.core.state.trust_tally import TrustTally
from base_station.core.state.unit_alert import MaydayCall, UnitAlert
from base_station.core.state.unit_trails import UnitTrails
from base_station.site.plan import Ring
from shared.channels import NO_TRACKER
from shared.clock import NS_PER_S
from shared.messages import (
    FusedPosition,
    Heartbeat,
    Position,
    Status,
    Temperature,
    UnitDescription,
)

ERASED_TEXT = "(forgotten)"  # in place of what was said of a person
WEARERS_KEPT = 20  # of a unit, beside those whom an alarm may be about; the log has all of them
STILL_NS = 300 * NS_PER_S  # after so long at the latest it is told who does not move


class Person(msgspec.Struct, frozen=True):
    """Wearer of a unit; name, crew and role only where the log is of an earlier version."""

    person_id: str
    name: str = ""
    crew: str = ""
    role: str = ""

    @property
    def named(self) -> str:
        """The name, or the reference in whose place it is shown."""
        return self.name or reference_to(self.person_id)


class FormerWearer(msgspec.Struct, frozen=True):
    """Former wearer of a unit; station times, ``until_ns`` excluded."""

    name: str
    from_ns: int
    until_ns: int


class Fault(msgspec.Struct, frozen=True):
    t_ns: int
    text: str


class GpsUse(msgspec.Struct, frozen=True):
    """Use of a unit's GNSS fixes; station times."""

    t_ns: int  # of the last one
    reason: str = ""  # why it is not used; empty: it is
    faulty_since_ns: int | None = None  # since when none of them can be true


class UnitState(MessageStream):
    """Times are station times of receipt unless a name says otherwise; None: never."""

    label: str = ""
    registered: bool = False
    person: Person | None = None
    worn_since_ns: int = 0  # by that person, or by nobody
    former_wearers: list[FormerWearer] = msgspec.field(default_factory=list)  # oldest first
    link: Link = "never"
    status: Status | None = None
    status_ns: int = 0
    temperature: Temperature | None = None
    temperature_ns: int = 0
    heat_dose: float = 0.0  # in this incident; 1: the equipment's heat budget is used up
    late_heat_dose: float = 0.0  # of that, what came out of the journal
    exposures: list[ExposureInterval] = msgspec.field(default_factory=list)
    position: Position | None = None
    position_ns: int = 0
    degraded_since_ns: int | None = None
    description: UnitDescription | None = None
    heartbeat: Heartbeat | None = None
    fused: FusedPosition | None = None
    position_lost_since_ns: int | None = None  # the fused position is lost
    last_backfill_s: int = 0  # of which second of station time it was told last, late, where it was
    trails: UnitTrails = msgspec.field(default_factory=UnitTrails)
    trust: TrustTally = msgspec.field(default_factory=TrustTally)  # in this incident
    mayday: MaydayCall = msgspec.field(default_factory=MaydayCall)
    fall: UnitAlert = msgspec.field(default_factory=UnitAlert)
    fault: Fault | None = None
    inside_since_ns: int | None = None
    reach: Ring = ()  # not heard: the border of what can be walked to by now, where a plan tells
    duty: Duty | None = None  # somebody wears it and an incident is open
    off_duty_ns: int = 0  # when that was last over
    tracker: UnitState | None = None  # what is known of its tracking agent as a sender
    gps: GpsUse | None = None
    rejected_counts: dict[str, int] = msgspec.field(
        default_factory=dict
    )  # fixes, sightings; by reason

    @property
    def name(self) -> str:
        """Name of the unit for people, with a reference in the place of its wearer's."""
        return self.person.named if self.person else self.label or self.unit_id

    def name_at(self, t_ns: int | None) -> str:
        """Name for people at that time, by its wearer then; None: the time is unknown."""
        if t_ns is None:
            before = [one.name for one in self.former_wearers if one.name != self.name]
            return " or, before, ".join([self.name, *before[-1:]])
        if t_ns >= self.worn_since_ns:
            return self.name
        worn = self._worn_at(t_ns)
        return worn.name if worn else self.label or self.unit_id

    def worn_from_ns(self, t_ns: int | None) -> int | None:
        """When whoever wore it then began to, 0: nobody did; names one wearing of this unit."""
        if t_ns is None:
            return None
        if t_ns >= self.worn_since_ns:
            return self.worn_since_ns if self.person else 0
        worn = self._worn_at(t_ns)
        return worn.from_ns if worn else 0

    def _worn_at(self, t_ns: int) -> FormerWearer | None:
        worn = [one for one in self.former_wearers if one.from_ns <= t_ns < one.until_ns]
        return worn[-1] if worn else None

    def end_wearing(self, t_ns: int) -> None:
        """Whoever wears it does so no more."""
        if self.person is not None:
            former = FormerWearer(self.person.named, self.worn_since_ns, t_ns)
            wearers = [*self.former_wearers, former]
            concerned = [one for one in wearers[:-WEARERS_KEPT] if self._concerns(one)]
            self.former_wearers = [*concerned, *wearers[-WEARERS_KEPT:]]
        self.person, self.worn_since_ns, self.inside_since_ns = None, t_ns, None

    def _concerns(self, worn: FormerWearer) -> bool:
        """True if a press, a fall or a rest that it told last was in that time: whose that was does
        not change with the next wearers.
        """
        alerts = [alert for alert in (self.mayday, self.fall) if alert.t_ns is not None]
        if any(worn.from_ns <= alert.event_ns < worn.until_ns for alert in alerts):
            return True
        if self.status is None:
            return False
        still_ns = self.status_ns - round(self.status.motionless_s * NS_PER_S)
        return worn.from_ns < still_ns + STILL_NS and still_ns < worn.until_ns

    def forget_wearers(self) -> None:
        """Erase the names of former wearers; that the unit was worn stays."""
        self.former_wearers = [
            msgspec.structs.replace(one, name=ERASED_TEXT) for one in self.former_wearers
        ]

    @property
    def began_ns(self) -> int:
        """When the run of its program began that is shown; what was before tells nothing of now."""
        return self.boots[-1].first_live_ns if self.boots else 0

    @property
    def is_tracked_remotely(self) -> bool:
        """It says itself that it does not track; nobody may do it for another unit."""
        return self.description is not None and self.description.tracker == NO_TRACKER

    @property
    def can_be_notified(self) -> bool | None:
        """True if it has an output that notifies its wearer; None: it has not described itself."""
        return None if self.description is None else bool(self.description.outputs)

    @property
    def path_boot(self) -> BootState:
        """In whose clock, and since whose start, its positions are: of a run that has only just
        begun there are none yet.
        """
        boots, position = self._path_boots, self.position
        if position is None or boots[-1].boot_id == position.header.boot_id:  # nearly always
            return boots[-1]
        return self.path_boot_of(position) or boots[-1]

    def path_boot_of(self, position: Position) -> BootState | None:
        """The run that said this position; None: nobody knows it."""
        boot_id = position.header.boot_id
        return next((one for one in reversed(self._path_boots) if one.boot_id == boot_id), None)

    @property
    def _path_boots(self) -> list[BootState]:
        """The runs of its program, or of the agent that tracks for it."""
        agent = self.tracker
        return self.boots if agent is None or not self.is_tracked_remotely else agent.boots

    @property
    def shown_status(self) -> Status | None:
        """Its own status, with what only strides tell from the agent that tracks for it."""
        agent = self.tracker
        if self.status is None or agent is None or agent.status is None:
            return self.status
        if not self.is_tracked_remotely:
            return self.status
        gone = self.status_ns - agent.status_ns >= STALE_AFTER_S * NS_PER_S
        return msgspec.structs.replace(
            self.status,
            activity=self.status.activity if gone else agent.status.activity,
            steps=agent.status.steps,
            cadence_hz=0.0 if gone else agent.status.cadence_hz,
            floors_climbed=agent.status.floors_climbed,
        )

    def count_rejected(self, reason: str) -> None:
        """Count a message whose content was not used."""
        self.rejected_counts[reason] = self.rejected_counts.get(reason, 0) + 1
