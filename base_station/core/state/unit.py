"""State of one unit: its wearer, link, readings, position, trail, alerts and duty."""

from __future__ import annotations

import msgspec

from base_station.core.state.boot_state import BootState
from base_station.core.state.duty import Duty
from base_station.core.state.message_stream import STALE_AFTER_S, Link, MessageStream
from base_station.core.state.site import OWN_SITE_ID
from base_station.core.state.trust_tally import TrustTally
from base_station.core.state.unit_alert import MaydayCall, UnitAlert
from base_station.core.state.unit_heat import UnitHeat
from base_station.core.state.unit_place import UnitPlace
from base_station.core.state.unit_trails import UnitTrails
from base_station.core.state.unit_wearer import FormerWearer, UnitWearer
from shared.channels import NO_TRACKER
from shared.clock import NS_PER_S
from shared.coded_text import NO_CODE, TextCode
from shared.messages import (
    AlarmParameters,
    BodyPosture,
    Heartbeat,
    Mobility,
    Position,
    Status,
    UnitDescription,
)

STILL_NS = 300 * NS_PER_S  # a wearer at rest is published at least this often


class Fault(msgspec.Struct, frozen=True):
    t_ns: int
    text: str
    code: TextCode = NO_CODE  # of the text; NO_CODE: from an earlier version, or a foreign unit

    @property
    def parameters(self) -> AlarmParameters:
        """Parameters of the sentence of an alarm about it."""
        return AlarmParameters(
            fault=self.text,
            fault_code=self.code.code or None,
            fault_texts=self.code.texts,
            fault_numbers=self.code.numbers,
        )


class GpsUse(msgspec.Struct, frozen=True):
    """Use of a unit's GNSS fixes; station times."""

    t_ns: int  # of the last one
    reason: str = ""  # why it is not used; empty: it is
    faulty_since_ns: int | None = None  # start of the time in which all of them are wrong


class UnitState(MessageStream):
    """Times are station times of receipt unless a name says otherwise; None: never."""

    label: str = ""
    registered: bool = False
    incident_id: str = ""  # in which its wearer works; empty: unassigned
    site_id: str = OWN_SITE_ID  # incident whose frame its path and position use
    site_ns: int = 0  # since when they are; 0: always
    wearer: UnitWearer = msgspec.field(default_factory=UnitWearer)
    link: Link = "never"
    status: Status | None = None
    status_ns: int = 0
    heat: UnitHeat = msgspec.field(default_factory=UnitHeat)
    position: Position | None = None
    position_ns: int = 0
    degraded_since_ns: int | None = None
    description: UnitDescription | None = None
    heartbeat: Heartbeat | None = None
    place: UnitPlace = msgspec.field(default_factory=UnitPlace)
    trails: UnitTrails = msgspec.field(default_factory=UnitTrails)
    trust: TrustTally = msgspec.field(default_factory=TrustTally)  # in this incident
    mayday: MaydayCall = msgspec.field(default_factory=MaydayCall)
    fall: UnitAlert = msgspec.field(default_factory=UnitAlert)
    fault: Fault | None = None
    duty: Duty | None = None  # it has a wearer, and an incident is open
    off_duty_ns: int = 0  # when that was last over
    tracker: UnitState | None = None  # state of its tracking agent as a sender
    gps: GpsUse | None = None
    rejected_counts: dict[str, int] = msgspec.field(
        default_factory=dict
    )  # fixes, sightings; by reason

    @property
    def name(self) -> str:
        """Name of the unit for people, with a reference in the place of its wearer's."""
        person = self.wearer.person
        return person.named if person else self.label or self.unit_id

    def name_at(self, t_ns: int | None) -> str:
        """Name for people at that time, by its wearer then; None: the time is unknown."""
        wearer = self.wearer
        if t_ns is None:
            before = [one.name for one in wearer.former if one.name != self.name]
            return " or, before, ".join([self.name, *before[-1:]])
        if t_ns >= wearer.since_ns:
            return self.name
        worn = wearer.former_at(t_ns)
        return worn.name if worn else self.label or self.unit_id

    def names_at(self, t_ns: int | None) -> tuple[str, str | None]:
        """Return the unit's name for people at that time.  Where the time is unknown (None), the
        present one, and the name of the last other wearer, whom it may concern instead.
        """
        if t_ns is None:
            before = [one.name for one in self.wearer.former if one.name != self.name]
            return self.name, next(iter(before[-1:]), None)
        return self.name_at(t_ns), None

    def end_wearing(self, t_ns: int) -> None:
        """End the wearing by the present wearer."""
        self.wearer.end(t_ns, self._concerns)
        self.place.inside_since_ns = None

    def _concerns(self, worn: FormerWearer) -> bool:
        """True if its last mayday, fall or rest was in that time: it belongs to the wearer of that
        time.
        """
        alerts = [alert for alert in (self.mayday, self.fall) if alert.t_ns is not None]
        if any(worn.from_ns <= alert.event_ns < worn.until_ns for alert in alerts):
            return True
        if self.status is None:
            return False
        still_ns = self.status_ns - round(self.status.motionless_s * NS_PER_S)
        return worn.from_ns < still_ns + STILL_NS and still_ns < worn.until_ns

    @property
    def began_ns(self) -> int:
        """Begin of the run of its program that is shown; older data is not about the present."""
        return self.boots[-1].first_live_ns if self.boots else 0

    @property
    def is_tracked_remotely(self) -> bool:
        """It reports itself that it does not track; no other unit may be tracked for."""
        return self.description is not None and self.description.tracker == NO_TRACKER

    @property
    def can_be_notified(self) -> bool | None:
        """True if it has an output that notifies its wearer; None: it has not described itself."""
        return None if self.description is None else bool(self.description.outputs)

    @property
    def path_boot(self) -> BootState:
        """Boot whose clock its positions use; a run that has just begun has no positions yet."""
        boots, position = self._path_boots, self.position
        if position is None or boots[-1].boot_id == position.header.boot_id:  # nearly always
            return boots[-1]
        return self.path_boot_of(position) or boots[-1]

    def path_boot_of(self, position: Position) -> BootState | None:
        """The boot that reported this position; None: unknown."""
        boot_id = position.header.boot_id
        return next((one for one in reversed(self._path_boots) if one.boot_id == boot_id), None)

    @property
    def _path_boots(self) -> list[BootState]:
        """The runs of its program, or of the agent that tracks for it."""
        agent = self.tracker
        return self.boots if agent is None or not self.is_tracked_remotely else agent.boots

    @property
    def shown_status(self) -> Status | None:
        """Its own status, completed by the values that the tracking agent computes from strides;
        for a unit that sends only samples, the agent's status of the wearer.
        """
        agent = self.tracker
        if agent is None or agent.status is None or not self.is_tracked_remotely:
            return self.status
        if self.status is None:
            return msgspec.structs.replace(
                agent.status, battery=None, battery_left_s=None, mayday=False, electronics=()
            )
        gone = self.status_ns - agent.status_ns >= STALE_AFTER_S * NS_PER_S
        return msgspec.structs.replace(
            self.status,
            activity=self.status.activity if gone else agent.status.activity,
            steps=agent.status.steps,
            cadence_hz=0.0 if gone else agent.status.cadence_hz,
            floors_climbed=agent.status.floors_climbed,
            mobility=Mobility.UNKNOWN if gone else agent.status.mobility,
            posture=BodyPosture.UNKNOWN if gone else agent.status.posture,
            posture_confidence=0.0 if gone else agent.status.posture_confidence,
        )

    @property
    def shown_status_ns(self) -> int:
        """Time of receipt of the status that is shown."""
        agent = self.tracker
        return agent.status_ns if self.status is None and agent is not None else self.status_ns

    def count_rejected(self, reason: str) -> None:
        """Count a message whose content was not used."""
        self.rejected_counts[reason] = self.rejected_counts.get(reason, 0) + 1
