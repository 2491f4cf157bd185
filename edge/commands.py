"""What a unit does with the station's commands, each once."""

from __future__ import annotations

import logging
from collections import OrderedDict
from collections.abc import Callable

from shared.envelope import Stamper
from shared.messages import Command, CommandKind, CommandReply, CommandState

logger = logging.getLogger(__name__)

POSITION_RATE_HZ = (0.1, 50.0)
_REMEMBERED = 1000


class CommandDesk:
    """Applies commands and answers them; a repeat gets the first answer again, and no more."""

    def __init__(self, stamper: Stamper, set_position_rate: Callable[[float], None]) -> None:
        self._stamper = stamper
        self._set_position_rate = set_position_rate
        self._answers: OrderedDict[str, tuple[CommandState, str]] = OrderedDict()

    def take(self, command: Command, now_utc_ns: int) -> CommandReply:
        answer = self._answers.get(command.command_id)
        if answer is None:
            answer = self._apply(command, now_utc_ns)
            self._answers[command.command_id] = answer
            if len(self._answers) > _REMEMBERED:
                self._answers.popitem(last=False)
        return CommandReply(self._stamper.header(), command.command_id, *answer)

    def _apply(self, command: Command, now_utc_ns: int) -> tuple[CommandState, str]:
        if 0 < command.expires_utc_ns < now_utc_ns:
            return CommandState.REFUSED, "it had expired when it came"
        match command.kind:
            case CommandKind.UNKNOWN:
                return CommandState.REFUSED, "this unit does not know this kind of command"
            case CommandKind.SET_POSITION_RATE:
                least_hz, most_hz = POSITION_RATE_HZ
                if not least_hz <= command.position_rate_hz <= most_hz:
                    return (
                        CommandState.REFUSED,
                        f"{command.position_rate_hz:g} Hz is not between {least_hz:g} and "
                        f"{most_hz:g} Hz",
                    )
                self._set_position_rate(command.position_rate_hz)
        logger.info("%s from %s %s", command.kind.name, command.issued_by, command.text)
        return CommandState.RECEIVED, ""
