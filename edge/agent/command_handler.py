"""Handler of the station's commands: each is applied once and answered."""

from __future__ import annotations

import logging
import re
from collections import OrderedDict
from collections.abc import Callable, Iterable

import msgspec

from edge.agent.mayday_progress import MaydayProgress
from edge.config import POSITION_RATE_HZ
from shared.envelope import Stamper
from shared.messages import ASKS_WEARER, Command, CommandKind, CommandReply, CommandState

logger = logging.getLogger(__name__)

REMEMBERED = 1000
UNANSWERED = frozenset({CommandState.RECEIVED, CommandState.NOTIFIED})
_RATE_SET = "positions at {:g} Hz"
_NO_POSITIONS = "this unit sends no positions: an agent at the station tracks for it"
_OTHER_MAYDAY = "the wearer has cancelled this mayday, or called another one since"
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
    """

    def __init__(
        self,
        stamper: Stamper,
        set_position_rate: Callable[[float], None] | None,
        known_replies: Iterable[CommandReply] = (),
        maydays: MaydayProgress | None = None,
    ) -> None:
        self._stamper = stamper
        self._set_position_rate = set_position_rate
        self._maydays = maydays or MaydayProgress()
        self._replies: OrderedDict[str, CommandReply] = OrderedDict()
        for reply in known_replies:
            self._remember(reply)

    def take(self, command: Command) -> CommandReply:
        reply = self._replies.get(command.command_id)
        if reply is None:
            state, detail = self._apply(command)
        else:
            state, detail = reply.state, reply.detail
        # One that was ended and comes again waits for the wearer again.
        asks = state in UNANSWERED and command.kind in ASKS_WEARER
        reply = CommandReply(self._stamper.header(), command.command_id, state, detail, asks)
        self._remember(reply)
        return reply

    def end(self, command_id: str) -> None:
        """Ask the button for an answer to this command no more."""
        reply = self._replies.get(command_id)
        if reply is not None:
            self._remember(msgspec.structs.replace(reply, awaits_wearer=False))

    def acknowledge(self) -> tuple[CommandReply, ...]:
        """Answer everything that asked for the button, which the wearer has pressed."""
        command_ids = [reply.command_id for reply in self._replies.values() if reply.awaits_wearer]
        replies = tuple(
            CommandReply(self._stamper.header(), command_id, CommandState.ACKNOWLEDGED, "button")
            for command_id in command_ids
        )
        for reply in replies:
            self._remember(reply)
        return replies

    def note_notified(self, command_id: str) -> CommandReply | None:
        """Answer that an output has notified the wearer; None where that is no news."""
        reply = self._replies.get(command_id)
        if reply is None or reply.state is not CommandState.RECEIVED:
            return None
        notified = msgspec.structs.replace(
            reply, header=self._stamper.header(), state=CommandState.NOTIFIED
        )
        self._remember(notified)
        return notified

    def has_notified(self, command_id: str) -> bool:
        """True if the newest answer is that an output has notified the wearer."""
        reply = self._replies.get(command_id)
        return reply is not None and reply.state is CommandState.NOTIFIED

    def _remember(self, reply: CommandReply) -> None:
        self._replies[reply.command_id] = reply
        if len(self._replies) > REMEMBERED:
            self._replies.popitem(last=False)

    def _apply(self, command: Command) -> tuple[CommandState, str]:
        # By the station's own clock alone: a unit whose clock is wrong obeys all the same.
        if 0 < command.expires_utc_ns <= command.header.t_utc_ns:
            return CommandState.REFUSED, "it had expired when it was sent"
        detail = ""
        match command.kind:
            case CommandKind.UNKNOWN:
                return CommandState.REFUSED, "this unit does not know this kind of command"
            case CommandKind.SET_POSITION_RATE:
                if self._set_position_rate is None:
                    return CommandState.REFUSED, _NO_POSITIONS
                least_hz, most_hz = POSITION_RATE_HZ
                if not least_hz <= command.position_rate_hz <= most_hz:
                    return (
                        CommandState.REFUSED,
                        f"{command.position_rate_hz:g} Hz is not between {least_hz:g} and "
                        f"{most_hz:g} Hz",
                    )
                self._set_position_rate(command.position_rate_hz)
                detail = _RATE_SET.format(command.position_rate_hz)
            case CommandKind.MAYDAY_ACKNOWLEDGED if not self._maydays.is_acknowledged_by(command):
                return CommandState.REFUSED, _OTHER_MAYDAY
        logger.info("%s from %s %s", command.kind.name, command.issued_by, command.text)
        return CommandState.RECEIVED, detail
