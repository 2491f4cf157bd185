"""Commands of the station to a unit, and the unit's replies."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.coded_text import NO_CODE, TextCode, with_code
from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import command_pb2
from shared.messages.quantise import unsigned32
from shared.messages.text_code import get_text_code, put_text_code


class CommandKind(IntEnum):
    UNKNOWN = 0
    EVACUATE = 1
    PAR_REQUEST = 2
    TEXT = 3
    LOCATE = 4
    SET_POSITION_RATE = 5
    RESET_ALARM = 6
    MAYDAY_ACKNOWLEDGED = 7
    END_ORDER = 8
    ALARM_ACKNOWLEDGED = 9
    ALL_CLEAR = 10


# Done when the wearer has acknowledged it; the others are done when the unit has them.
ASKS_WEARER = frozenset(
    {
        CommandKind.EVACUATE,
        CommandKind.PAR_REQUEST,
        CommandKind.TEXT,
        CommandKind.ALL_CLEAR,
    }
)
# The wearer's press answers these; a LOCATE is stopped by it.
ANSWERED_BY_PRESS = ASKS_WEARER | {CommandKind.LOCATE}
# Those of the station itself, which follow from what an operator does; nobody orders them.
OF_STATION = frozenset(
    {CommandKind.MAYDAY_ACKNOWLEDGED, CommandKind.END_ORDER, CommandKind.ALARM_ACKNOWLEDGED}
)


# How a unit signals its place, as the detail of its reply to a LOCATE.
SOUND, LIGHT = "sound", "light"


class CommandState(IntEnum):
    UNKNOWN = 0
    RECEIVED = 1
    ACKNOWLEDGED = 2  # by the wearer
    REFUSED = 3
    NOTIFIED = 4  # received, and an output of the unit has notified the wearer


class Command(msgspec.Struct, frozen=True):
    header: Header
    command_id: str
    kind: CommandKind
    issued_by: str
    expires_utc_ns: int
    text: str = ""
    position_rate_hz: float = 0.0
    ended_command_id: str = ""  # for END_ORDER and ALL_CLEAR
    # For MAYDAY_ACKNOWLEDGED: the message by which the station last knew of the mayday.
    mayday_boot_id: int = 0
    mayday_seq: int = 0
    repeats: str = ""  # id of the order that is sent again; empty: this is a new one

    def to_wire(self) -> command_pb2.Command:
        return command_pb2.Command(
            header=self.header.to_wire(),
            command_id=self.command_id,
            kind=int(self.kind),  # type: ignore[arg-type]  # stubs want the generated enum
            issued_by=self.issued_by,
            expires_utc_ns=self.expires_utc_ns,
            text=self.text,
            position_rate_mhz=unsigned32(self.position_rate_hz, 1e3),
            ended_command_id=self.ended_command_id,
            mayday_boot_id=self.mayday_boot_id,
            mayday_seq=self.mayday_seq,
            repeats=self.repeats,
        )

    @staticmethod
    def from_wire(wire: command_pb2.Command) -> Command:
        return Command(
            header=Header.from_wire(wire.header),
            command_id=wire.command_id,
            kind=known(CommandKind, wire.kind),
            issued_by=wire.issued_by,
            expires_utc_ns=wire.expires_utc_ns,
            text=wire.text,
            position_rate_hz=wire.position_rate_mhz * 1e-3,
            ended_command_id=wire.ended_command_id,
            mayday_boot_id=wire.mayday_boot_id,
            mayday_seq=wire.mayday_seq,
            repeats=wire.repeats,
        )


class CommandReply(msgspec.Struct, frozen=True):
    header: Header
    command_id: str
    state: CommandState
    detail: str = ""
    awaits_wearer: bool = False  # received; the wearer has yet to acknowledge it
    repeats: str = ""  # as in the command
    ended_command_id: str = ""  # of the evacuation that an ALL_CLEAR has ended
    text_code: TextCode = NO_CODE  # of ``detail``, where it has one

    @property
    def reason(self) -> str:
        """The detail with its code."""
        return with_code(self.detail, self.text_code)

    def to_wire(self) -> command_pb2.CommandReply:
        wire = command_pb2.CommandReply(
            header=self.header.to_wire(),
            command_id=self.command_id,
            state=int(self.state),  # type: ignore[arg-type]  # stubs want the generated enum
            detail=self.detail,
            awaits_wearer=self.awaits_wearer,
            repeats=self.repeats,
            ended_command_id=self.ended_command_id,
        )
        if self.text_code.code:
            put_text_code(wire.text_code, self.text_code)
        return wire

    @staticmethod
    def from_wire(wire: command_pb2.CommandReply) -> CommandReply:
        return CommandReply(
            header=Header.from_wire(wire.header),
            command_id=wire.command_id,
            state=known(CommandState, wire.state),
            detail=wire.detail,
            awaits_wearer=wire.awaits_wearer,
            repeats=wire.repeats,
            ended_command_id=wire.ended_command_id,
            text_code=get_text_code(wire.text_code),
        )
