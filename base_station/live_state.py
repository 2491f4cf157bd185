"""What the station knows at this instant: of every unit, of the incident and of itself.

Plain data that the pipeline alone changes; all of it can be written out and read back, so that
a station starts again from a checkpoint instead of from the beginning of the log.
"""

from __future__ import annotations

import msgspec

from base_station.assessment.tally import TrustTally
from base_station.commands.state import SentCommand
from base_station.fusion.fixes.sky import Sky
from base_station.fusion.learnt.building import LearntBuilding
from base_station.fusion.path.history import PathHistory
from base_station.fusion.vertical.weather import Barometers
from base_station.pins.late_history import Late
from base_station.pins.pin import Beacon, Pin, PinVerdict
from base_station.site.learnt_floors import LearntFloors
from base_station.site.plan import Plan, Ring
from base_station.site.storeys import Storey
from base_station.units.boot_state import BootState
from base_station.units.heat_told import HeatStretch
from base_station.units.sender import STALE_AFTER_S, Link, Sender
from base_station.units.trail import TRAIL_POINTS, TrailStep, extend_trail, fill_trail
from base_station.work_limits import PAR_INTERVAL_S, WORK_LIMIT_S
from shared.channels import NO_TRACKER, tracked_unit
from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.messages import (
    AlarmState,
    FusedPosition,
    Heartbeat,
    Position,
    Status,
    Temperature,
    UnitDescription,
)
from shared.messages.station import TakeOver

FORGOTTEN = "(forgotten)"  # in place of what was said of a person
WEARERS_KEPT = 20  # of a unit, beside those whom an alarm may be about; the log has all of them
STILL_NS = 300 * NS_PER_S  # after so long at the latest it is told who does not move


class Person(msgspec.Struct, frozen=True):
    person_id: str
    name: str
    crew: str
    role: str


class FormerWearer(msgspec.Struct, frozen=True):
    """Who wore a unit before; station times, ``until_ns`` left out."""

    name: str
    from_ns: int
    until_ns: int


class Incident(msgspec.Struct, frozen=True):
    incident_id: str
    name: str
    opened_ns: int
    closed_ns: int | None = None
    par_interval_s: float = PAR_INTERVAL_S  # everybody is to be heard from this often
    work_limit_s: float = WORK_LIMIT_S  # of work, after which somebody should rest


class Duty(msgspec.Struct):
    """What is asked of somebody who wears a unit while an incident is open; station times."""

    checked_in_ns: int  # when a person last vouched for the wearer
    checked_in_by: str
    asks_ns: list[int] = msgspec.field(default_factory=list)  # calls not answered, oldest first
    ready_ns: int = 0  # since when on duty and not at rest
    work_since_ns: int | None = None
    rest_since_ns: int | None = None
    due_ns: int = 0  # of the next check-in
    rest_due_ns: int | None = None

    @property
    def asked_ns(self) -> int | None:
        """Since when a roll call waits for the answer."""
        return self.asks_ns[0] if self.asks_ns else None


class Fault(msgspec.Struct, frozen=True):
    t_ns: int
    text: str


class GpsUse(msgspec.Struct, frozen=True):
    """What became of a unit's fixes; station times."""

    t_ns: int  # of the last one
    reason: str = ""  # why it is not used; empty: it is
    faulty_since_ns: int | None = None  # since when none of them can be true


class UnitState(Sender):
    """Times are station times of receipt unless a name says otherwise; None: never."""

    label: str = ""
    registered: bool = False
    person: Person | None = None
    worn_since_ns: int = 0  # by that person, or by nobody
    worn_before: list[FormerWearer] = msgspec.field(default_factory=list)  # oldest first
    link: Link = "never"
    status: Status | None = None
    status_ns: int = 0
    temperature: Temperature | None = None
    temperature_ns: int = 0
    heat_dose: float = 0.0  # in this incident; 1: the equipment's heat budget is used up
    late_heat_dose: float = 0.0  # of that, what came out of the journal
    heat_told: list[HeatStretch] = msgspec.field(default_factory=list)
    position: Position | None = None
    position_ns: int = 0
    degraded_since_ns: int | None = None
    description: UnitDescription | None = None
    heartbeat: Heartbeat | None = None
    fused: FusedPosition | None = None
    unplaced_since_ns: int | None = None  # the fused position is lost
    recalled_s: int = 0  # of which second of station time it was told last, late, where it was
    trail: list[TrailStep] = msgspec.field(default_factory=list)
    plain_trail: list[TrailStep] | None = None  # as it would be without any pin; None: as it is
    trust: TrustTally = msgspec.field(default_factory=TrustTally)  # in this incident
    mayday_ns: int | None = None  # when it was last told that the button was pressed
    mayday_said_ns: int = 0  # and when the unit said that: it may have waited in its journal
    mayday_is_dated: bool = True  # else nobody can tell when it was said
    mayday_cancelled_ns: int | None = None  # since then
    mayday_cancelled_said_ns: int = 0
    fall_ns: int | None = None
    fall_said_ns: int = 0
    fall_is_dated: bool = True
    fault: Fault | None = None
    inside_since_ns: int | None = None
    reach: Ring = ()  # not heard: the border of what can be walked to by now, where a plan tells
    duty: Duty | None = None  # somebody wears it and an incident is open
    off_duty_ns: int = 0  # when that was last over
    tracker: UnitState | None = None  # what is known of its tracking agent as a sender
    gps: GpsUse | None = None
    not_used: dict[str, int] = msgspec.field(default_factory=dict)  # fixes, sightings; by reason

    @property
    def name(self) -> str:
        """What a person would call the unit."""
        return self.person.name if self.person else self.label or self.unit_id

    def name_at(self, t_ns: int | None) -> str:
        """What a person would have called it then, by who wore it; None: nobody can tell when."""
        if t_ns is None:
            before = [one.name for one in self.worn_before if one.name != self.name]
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
        worn = [one for one in self.worn_before if one.from_ns <= t_ns < one.until_ns]
        return worn[-1] if worn else None

    def end_wearing(self, t_ns: int) -> None:
        """Whoever wears it does so no more."""
        if self.person is not None:
            former = FormerWearer(self.person.name, self.worn_since_ns, t_ns)
            wearers = [*self.worn_before, former]
            told_of = [one for one in wearers[:-WEARERS_KEPT] if self._tells_of(one)]
            self.worn_before = [*told_of, *wearers[-WEARERS_KEPT:]]
        self.person, self.worn_since_ns, self.inside_since_ns = None, t_ns, None

    def _tells_of(self, worn: FormerWearer) -> bool:
        """Whether a press, a fall or a rest that it told last was in that time: whose that was does
        not change with the next wearers.
        """
        said_ns = [
            said_ns
            for t_ns, said_ns in (
                (self.mayday_ns, self.mayday_said_ns),
                (self.fall_ns, self.fall_said_ns),
            )
            if t_ns is not None
        ]
        if any(worn.from_ns <= one < worn.until_ns for one in said_ns):
            return True
        if self.status is None:
            return False
        still_ns = self.status_ns - round(self.status.motionless_s * NS_PER_S)
        return worn.from_ns < still_ns + STILL_NS and still_ns < worn.until_ns

    def forget_wearers(self) -> None:
        """That somebody wore it then is left of those before."""
        self.worn_before = [
            msgspec.structs.replace(one, name=FORGOTTEN) for one in self.worn_before
        ]

    @property
    def began_ns(self) -> int:
        """When the run of its program began that is shown; what was before tells nothing of now."""
        return self.boots[-1].there_from_ns if self.boots else 0

    @property
    def is_tracked_remotely(self) -> bool:
        """It says itself that it does not track; nobody may do it for another unit."""
        return self.description is not None and self.description.tracker == NO_TRACKER

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

    def extend_trail(self, fused: FusedPosition) -> bool:
        """Add a point where the wearer moved, at most one a second; True where one was added."""
        return extend_trail(self.trail, fused)

    def fill_trail(self, fused: FusedPosition) -> bool:
        """Put a point that came late in its place, where none is near in time."""
        return fill_trail(self.trail, fused)

    def extend_plain_trail(self, fused: FusedPosition) -> None:
        """Where the wearer would be shown without any pin."""
        if self.plain_trail is not None:
            extend_trail(self.plain_trail, fused)

    def fill_plain_trail(self, fused: FusedPosition) -> None:
        if self.plain_trail is not None:
            fill_trail(self.plain_trail, fused)

    def change_plain_trail(self, since_ns: int, trail: list[TrailStep]) -> None:
        """Without any pin, the wearer was elsewhere since then."""
        plain = self.trail if self.plain_trail is None else self.plain_trail
        before = [step for step in plain if step.t_ns < since_ns]
        plain[:] = [*before, *trail][-TRAIL_POINTS:]

    def show_solved_trail(self, trail: list[TrailStep]) -> None:
        """The past was solved with pins; what would be without is kept beside it."""
        if self.plain_trail is None:
            self.plain_trail = self.trail
        self.trail = trail

    def show_plain_trail(self) -> bool:
        """No pin is left that matters; True where that changes the trail."""
        if self.plain_trail is None:
            return False
        self.trail, self.plain_trail = self.plain_trail, None
        return True


class Alarm(msgspec.Struct):
    """An alarm in the book, open or resolved."""

    alarm_id: str
    rule: str
    unit_id: str  # empty: the station itself
    priority: int
    state: AlarmState
    level: str
    text: str
    by: str
    latched: bool  # only a person resolves it
    raised_ns: int
    about: int | str | None  # as its ``Finding`` says; None: its rule finds one at a time
    last_raised_ns: int  # at first, or anew: it got worse, or happened again
    changed_ns: int
    held: bool = False  # resolved by a person while the condition went on
    clear_since_ns: int | None = None  # time of the first evidence that it is over
    lower_since_ns: int | None = None  # time of the first evidence of a lower level

    @property
    def is_open(self) -> bool:
        return self.state is not AlarmState.RESOLVED


class DoneOnce(msgspec.Struct, frozen=True):
    """What became of a request that its client may send again (``base_station.once``)."""

    action_id: str
    t_ns: int
    made_id: str  # of the command, pin or incident; empty: it made none
    refused: str  # why it had no effect; empty: it had


class Counts(msgspec.Struct):
    messages: int = 0
    undecodable: int = 0
    last_undecodable: str = ""
    units_left_out: int = 0  # messages of strangers beyond what is kept


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
    past_incidents: list[Incident] = msgspec.field(default_factory=list)  # closed, oldest first
    plan: Plan | None = None
    anchor: Anchor | None = None
    anchor_by_gps: bool = False  # nobody said where the frame lies; the first good fix did
    fixes_anchor: Anchor | None = None  # as it was when a fix was taken last
    far_fixes: int = 0  # in a row, too far from there to be of this site
    sky: Sky = msgspec.field(default_factory=Sky)
    barometers: Barometers = msgspec.field(default_factory=Barometers)
    start_set: bool = False  # somebody said where a unit began
    paths: dict[str, PathHistory] = msgspec.field(default_factory=dict)  # of units
    pins: dict[str, Pin] = msgspec.field(default_factory=dict)  # in the order of setting
    pin_verdicts: dict[str, PinVerdict] = msgspec.field(default_factory=dict)
    beacons: dict[str, Beacon] = msgspec.field(default_factory=dict)
    trust_ns: int = 0  # when lights were last looked at
    sighted_ns: int = 0  # when a sighting was last solved at once
    late: dict[str, Late] = msgspec.field(default_factory=dict)  # pinned units: to be solved again
    learnt_building: LearntBuilding = LearntBuilding()
    learnt_floors: LearntFloors = msgspec.field(default_factory=LearntFloors)
    thresholds: dict[str, float] = msgspec.field(default_factory=dict)  # of alarm rules
    problems: dict[str, str] = msgspec.field(default_factory=dict)  # by part of the station
    done_once: dict[str, DoneOnce] = msgspec.field(default_factory=dict)  # by key, oldest first
    take_overs: list[TakeOver] = msgspec.field(default_factory=list)  # who has been in charge
    counts: Counts = msgspec.field(default_factory=Counts)

    def sender(self, unit_id: str) -> UnitState | None:
        """A unit, or the agent that tracks for one; None: it was never heard."""
        unit = self.units.get(unit_id)
        if unit is not None:  # nearly always
            return unit
        unit = self.units.get(tracked_unit(unit_id) or unit_id)
        return None if unit is None else unit.tracker

    @property
    def laid_plan(self) -> Plan | None:
        """The plan, unless nobody knows where on it people are: they are where the first fix put
        the frame, before there was any.
        """
        return None if self.anchor_by_gps else self.plan

    def storeys_at(self, north_m: float, east_m: float) -> tuple[Storey, ...]:
        """Of the building there, lowest first: the plan's, or else those that were learnt."""
        if self.plan is not None and self.plan.storeys:
            return self.plan.storeys
        return self.learnt_floors.storeys_at(north_m, east_m)
