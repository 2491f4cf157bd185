"""One change in the life of an alarm, as the station decided it."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.messages.fields import get_fields, put_fields
from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import alarm_pb2


class AlarmState(IntEnum):
    UNKNOWN = 0
    RAISED = 1
    ACKNOWLEDGED = 2
    RESOLVED = 3


class AlarmParameters(msgspec.Struct, frozen=True, omit_defaults=True):
    """Amounts and names in the sentence of an alarm; None: the sentence has none."""

    member: str | None = None  # who it is about, or the unit; {person ID} stands for a name
    member_before: str | None = None  # who wore the unit before, where it may be about them
    unit_id: str | None = None
    duration_s: float | None = None
    temperature_degc: float | None = None  # of the air around the equipment
    heat_fraction: float | None = None  # used part of the equipment's heat limit; 1: all of it
    battery_fraction: float | None = None
    radius_m: float | None = None  # that holds the member with 95 % probability
    reasons: tuple[str, ...] = ()  # why an estimate is poor, or a fix is not used; codes
    fault: str | None = None  # in words of the unit, its agent or the station
    part: str | None = None  # of the station, that fails
    calibrated_s: int | None = None  # UTC seconds
    fault_code: str | None = None  # of the sentence in ``fault``, where it has one
    fault_texts: dict[str, str] = msgspec.field(
        default_factory=dict
    )  # parameters of ``fault_code``, by name
    fault_numbers: dict[str, float] = msgspec.field(default_factory=dict)


NO_PARAMETERS = AlarmParameters()


class AlarmChange(msgspec.Struct, frozen=True):
    header: Header  # the station's; t_utc_ns is the station time of the change
    alarm_id: str  # the same through the alarm's life
    rule: str  # as in base_station.core.alarms.ALARMS
    unit_id: str  # empty: the station itself
    priority: int  # 1 immediate, 2 soon, 3 information
    state: AlarmState
    level: str  # within the rule: "pre-alert", "critical" ...
    text: str  # for a person
    by: str  # who acknowledged or resolved it, or what resolved it
    raised_ns: int  # station time of the first change
    last_raised_ns: int  # when it was raised anew last: worse, or again; or ``raised_ns``
    code: str = ""  # of the sentence in ``text``; empty: of an earlier version
    parameters: AlarmParameters = NO_PARAMETERS  # what the sentence says besides
    # Code of the user's reason for its resolution, or of the cause in ``by``; empty: there is none.
    reason: str = ""
    note: str = ""  # the user's words about it
    peak: float | None = None  # worst value so far of what the rule measures, in its unit

    def to_wire(self) -> alarm_pb2.AlarmChange:
        wire = alarm_pb2.AlarmChange(
            header=self.header.to_wire(),
            alarm_id=self.alarm_id,
            rule=self.rule,
            unit_id=self.unit_id,
            priority=self.priority,
            state=int(self.state),  # type: ignore[arg-type]  # stubs want the generated enum
            level=self.level,
            text=self.text,
            by=self.by,
            raised_ns=self.raised_ns,
            last_raised_ns=self.last_raised_ns,
            code=self.code,
            reason=self.reason,
            note=self.note,
            peak=self.peak,
        )
        put_fields(wire.parameters, self.parameters)
        return wire

    @staticmethod
    def from_wire(wire: alarm_pb2.AlarmChange) -> AlarmChange:
        return AlarmChange(
            header=Header.from_wire(wire.header),
            alarm_id=wire.alarm_id,
            rule=wire.rule,
            unit_id=wire.unit_id,
            priority=wire.priority,
            state=known(AlarmState, wire.state),
            level=wire.level,
            text=wire.text,
            by=wire.by,
            raised_ns=wire.raised_ns,
            last_raised_ns=wire.last_raised_ns,
            code=wire.code,
            parameters=AlarmParameters(**get_fields(wire.parameters, AlarmParameters)),
            reason=wire.reason,
            note=wire.note,
            peak=wire.peak if wire.HasField("peak") else None,
        )
