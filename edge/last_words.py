"""What a unit must not forget when it is cut off in mid-sentence."""

from __future__ import annotations

from edge.commands import REMEMBERED
from edge.spool import Spool
from shared.channels import EVENT, REPLY
from shared.codec import decode
from shared.messages import CommandReply, EventKind, UnitEvent


def mayday_before(spool: Spool) -> bool:
    """Whether a mayday was latched when the boot before this one came to a sudden end.

    A unit that was stopped in order has said so, and starts afresh.
    """
    boots = [boot for boot in spool.boots() if boot.boot_id != spool.boot_id]
    for payload in spool.newest_first(boots[-1].boot_id, EVENT) if boots else ():
        event = decode(EVENT, payload)
        assert isinstance(event, UnitEvent)
        if event.kind in (EventKind.STOPPED, EventKind.MAYDAY_CANCELLED):
            return False
        if event.kind is EventKind.MAYDAY:
            return True
    return False


def answers_before(spool: Spool) -> list[CommandReply]:
    """What this unit has answered to commands, oldest first, so that it does none of them again."""
    answers: list[CommandReply] = []
    for boot in reversed(spool.boots()):
        for payload in spool.newest_first(boot.boot_id, REPLY):
            answer = decode(REPLY, payload)
            assert isinstance(answer, CommandReply)
            answers.append(answer)
            if len(answers) == 2 * REMEMBERED:  # a command has one or two, seldom more
                return answers[::-1]
    return answers[::-1]
