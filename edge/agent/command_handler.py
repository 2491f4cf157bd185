"""Handler of the station's commands: each is applied once and answered."""

from __future__ import annotations

import logging
import re
from collections import OrderedDict
from collections.abc import Callable, Iterable

import msgspec

from edge.agent.mayday_progress import MaydayProgress
from edge.config import POSITION_RATE_HZ
from shared.coded_text import NO_CODE, code_of_text, coded
from shared.header_factory import HeaderFactory
from shared.messages import (
    ANSWERED_BY_PRESS,
    LIGHT,
    SOUND,
    Command,
    CommandKind,
    CommandReply,
    CommandState,
)

logger = logging.getLogger(__name__)

REMEMBERED = 1000
UNANSWERED = frozenset({CommandState.RECEIVED, CommandState.NOTIFIED})
_RATE_SET = "positions at {:g} Hz"
_NO_POSITIONS = coded(
    "refused-no-positions",
    "this unit sends no positions: an agent at the station tracks for it",
)
_OTHER_MAYDAY = coded(
    "refused-other-mayday",
    "the wearer has cancelled this mayday, or called another one since",
)
_ALL_CLEAR = coded("refused-all-clear", "the all clear was given for this evacuation")
_NO_OUTPUT = coded("refused-no-output", "this unit has no sounder and no light")
_BUTTON = "button"  # how the wearer has answered
_RATE_REPLY = re.compile(r"positions at (\d+(?:\.\d+)?) Hz")


def position_rate_of(reply: CommandReply) -> float | None:
    """Return the position rate (Hz) that a reply reports as set."""
    found = _RATE_REPLY.fullmatch(reply.detail)
    return float(found[1]) if found else None


class CommandHandler:
    """Handler that applies commands and answers them; a repeat gets the newest answer again.

    ``set_position_rate``: None where the unit does not track, and sends no positions.
    ``known_replies``: answers from before the program was started, oldest first.
    ``maydays``: None where the unit has no button, and calls none.
    ``has_outputs``: the unit has something to signal its place with.
    """

    def __init__(
        self,
        header_factory: HeaderFactory,
        set_position_rate: Callable[[float], None] | None,
        known_replies: Iterable[CommandReply] = (),
        maydays: MaydayProgress | None = None,
        *,
        has_outputs: bool = True,
    ) -> None:
        self._header_factory = header_factory
        self._set_position_rate = set_position_rate
        self._maydays = maydays or MaydayProgress()
        self._has_outputs = has_outputs
        self._replies: OrderedDict[str, CommandReply] = OrderedDict()
        for reply in known_replies:
            self._remember(reply)

    def take(self, command: Command) -> CommandReply:
        reply = self._replies.get(command.command_id)
        detail: str
        if self._is_over(command):
            state, detail = CommandState.REFUSED, _ALL_CLEAR
        elif reply is None:
            state, detail = self._apply(command)
        else:
            state, detail = reply.state, reply.reason
        # A command that was ended and is sent again waits for the wearer again.
        asks = state in UNANSWERED and command.kind in ANSWERED_BY_PRESS
        is_all_clear = command.kind is CommandKind.ALL_CLEAR and state in UNANSWERED
        ended = command.ended_command_id if is_all_clear else ""
        header = self._header_factory.header()
        reply = CommandReply(
            header,
            command.command_id,
            state,
            str(detail),
            asks,
            command.repeats,
            ended,
            code_of_text(detail),
        )
        self._remember(reply)
        return reply

    def end(self, command_id: str) -> None:
        """Stop waiting for the button to answer this command and its repeats."""
        for reply in self._answers_to(command_id):
            self._remember(msgspec.structs.replace(reply, awaits_wearer=False))

    def acknowledge(self) -> tuple[CommandReply, ...]:
        """Answer all commands that wait for the button, which the wearer has pressed."""
        replies = tuple(
            msgspec.structs.replace(
                reply,
                header=self._header_factory.header(),
                state=CommandState.ACKNOWLEDGED,
                detail=_BUTTON,
                text_code=NO_CODE,
                awaits_wearer=False,
            )
            for reply in self._replies.values()
            if reply.awaits_wearer
        )
        for reply in replies:
            self._remember(reply)
        return replies

    def note_notified(self, command_id: str, signal: str = "") -> CommandReply | None:
        """Answer that an output has notified the wearer; None where that was answered before.
        ``signal``: how a LOCATE is signalled, by SOUND or by LIGHT alone.
        """
        reply = self._replies.get(command_id)
        is_louder = reply is not None and (reply.detail, signal) == (LIGHT, SOUND)
        if reply is None or reply.state not in UNANSWERED:
            return None
        if reply.state is CommandState.NOTIFIED and not is_louder:
            return None
        notified = msgspec.structs.replace(
            reply,
            header=self._header_factory.header(),
            state=CommandState.NOTIFIED,
            detail=signal or reply.detail,
        )
        self._remember(notified)
        return notified

    def has_notified(self, command_id: str) -> bool:
        """True if the newest answer is that an output has notified the wearer."""
        reply = self._replies.get(command_id)
        return reply is not None and reply.state is CommandState.NOTIFIED

    def _answers_to(self, command_id: str) -> list[CommandReply]:
        """Newest answers to a command and to what repeats it."""
        return [
            reply
            for reply in self._replies.values()
            if command_id in (reply.command_id, reply.repeats)
        ]

    def _is_over(self, command: Command) -> bool:
        """True if the all clear was given for this evacuation: it is never played again."""
        if command.kind is not CommandKind.EVACUATE:
            return False
        order_id = command.repeats or command.command_id
        return any(reply.ended_command_id == order_id for reply in self._replies.values())

    def _is_answered(self, command: Command) -> bool:
        """True if the wearer has answered the order that this one repeats."""
        answers = self._answers_to(command.repeats) if command.repeats else []
        return any(reply.state is CommandState.ACKNOWLEDGED for reply in answers)

    def _remember(self, reply: CommandReply) -> None:
        self._replies[reply.command_id] = reply
        if len(self._replies) > REMEMBERED:
            self._replies.popitem(last=False)

    def _apply(self, command: Command) -> tuple[CommandState, str]:
        reason = self._refusal(command)
        if reason:
            return CommandState.REFUSED, reason
        if self._is_answered(command):
            return CommandState.ACKNOWLEDGED, _BUTTON
        logger.info("%s from %s %s", command.kind.name, command.issued_by, command.text)
        if command.kind is CommandKind.SET_POSITION_RATE and self._set_position_rate is not None:
            self._set_position_rate(command.position_rate_hz)
            return CommandState.RECEIVED, _RATE_SET.format(command.position_rate_hz)
        return CommandState.RECEIVED, ""

    def _refusal(self, command: Command) -> str:
        """Reason that the unit does not execute the command; empty: it does."""
        # By the station's clock alone, so that a unit with a wrong clock executes it too.
        if 0 < command.expires_utc_ns <= command.header.t_utc_ns:
            return coded("refused-expired", "it had expired when it was sent")
        match command.kind:
            case CommandKind.UNKNOWN:
                return coded("refused-unknown", "this unit does not know this kind of command")
            case CommandKind.SET_POSITION_RATE:
                tracks = self._set_position_rate is not None
                return _out_of_range(command.position_rate_hz) if tracks else _NO_POSITIONS
            case CommandKind.LOCATE if not self._has_outputs:
                return _NO_OUTPUT
            case CommandKind.MAYDAY_ACKNOWLEDGED if not self._maydays.is_acknowledged_by(command):
                return _OTHER_MAYDAY
        return ""


def _out_of_range(rate_hz: float) -> str:
    least_hz, most_hz = POSITION_RATE_HZ
    if least_hz <= rate_hz <= most_hz:
        return ""
    return coded(
        "refused-rate",
        "{rate_hz:g} Hz is not between {least_hz:g} and {most_hz:g} Hz",
        rate_hz=rate_hz,
        least_hz=least_hz,
        most_hz=most_hz,
    )
