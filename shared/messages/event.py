"""Things that happened to a unit and must not be missed, and its sign of life."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.coded_text import NO_CODE, TextCode, code_of_text
from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import event_pb2
from shared.messages.quantise import signed32, unsigned_known
from shared.messages.text_code import get_text_code, put_text_code

FAILED = "failed"  # the detail of a stop by an error


class EventKind(IntEnum):
    UNKNOWN = 0
    MAYDAY = 1
    MAYDAY_CANCELLED = 2
    FALL = 3
    STARTED = 4
    STOPPED = 5
    SENSOR_FAULT = 6
    STORAGE_FAULT = 7
    SOURCE_ENDED = 8
    ACKNOWLEDGED = 9  # in the black box: the wearer's press, whatever it answers


class UnitEvent(msgspec.Struct, frozen=True):
    header: Header
    kind: EventKind
    detail: str = ""  # for a person
    text_code: TextCode = NO_CODE  # of ``detail``, where it has one

    @staticmethod
    def of(header: Header, kind: EventKind, detail: str) -> UnitEvent:
        """With the code of the detail, where it has one."""
        return UnitEvent(header, kind, str(detail), code_of_text(detail))

    @property
    def is_stop_in_order(self) -> bool:
        """Somebody switched the unit off; one that has failed says that it stops, too."""
        return self.kind is EventKind.STOPPED and self.detail != FAILED

    def to_wire(self) -> event_pb2.UnitEvent:
        wire = event_pb2.UnitEvent(
            header=self.header.to_wire(),
            kind=int(self.kind),  # type: ignore[arg-type]  # stubs want the generated enum
            detail=self.detail,
        )
        if self.text_code.code:
            put_text_code(wire.text_code, self.text_code)
        return wire

    @staticmethod
    def from_wire(wire: event_pb2.UnitEvent) -> UnitEvent:
        return UnitEvent(
            header=Header.from_wire(wire.header),
            kind=known(EventKind, wire.kind),
            detail=wire.detail,
            text_code=get_text_code(wire.text_code),
        )


class Heartbeat(msgspec.Struct, frozen=True):
    """The unit is alive and can still serve its journal from ``first_seq`` to ``last_seq``."""

    header: Header
    first_seq: int
    last_seq: int
    clock_ahead_s: float = 0.0  # the unit's own UTC less the station's
    clock_std_s: float = 0.0  # of that estimate; 0: the station never answered
    clock_drift: float = 0.0  # of the station's clock against the unit's monotonic one
    never_saved: int = 0  # messages since the start that were sent and could not be kept
    given_up: int = 0  # and that were kept, and gave room before the station had them

    def to_wire(self) -> event_pb2.Heartbeat:
        return event_pb2.Heartbeat(
            header=self.header.to_wire(),
            first_seq=self.first_seq,
            last_seq=self.last_seq,
            clock_ahead_us=round(self.clock_ahead_s * 1e6),
            clock_std_us=unsigned_known(self.clock_std_s, 1e6),
            clock_drift_ppb=signed32(self.clock_drift, 1e9),
            never_saved=self.never_saved,
            given_up=self.given_up,
        )

    @staticmethod
    def from_wire(wire: event_pb2.Heartbeat) -> Heartbeat:
        return Heartbeat(
            header=Header.from_wire(wire.header),
            first_seq=wire.first_seq,
            last_seq=wire.last_seq,
            clock_ahead_s=wire.clock_ahead_us * 1e-6,
            clock_std_s=wire.clock_std_us * 1e-6,
            clock_drift=wire.clock_drift_ppb * 1e-9,
            never_saved=wire.never_saved,
            given_up=wire.given_up,
        )
