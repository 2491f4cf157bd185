"""What was said before this start and must not be forgotten: a mayday, answers to commands, and the
rate of positions that one of them set.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator

from edge.commands import REMEMBERED, position_rate_of
from edge.journal.spool import Spool
from shared.channels import EVENT, REPLY, Channel
from shared.codec import decode
from shared.errors import StoreError, WireError
from shared.messages import CommandReply, EventKind, JournalBoot, Message, UnitEvent

logger = logging.getLogger(__name__)


def mayday_before(spool: Spool) -> bool:
    """Whether a mayday was latched when the boot before this one came to a sudden end.

    A unit that was stopped in order has said so, and starts afresh; one that has failed had the
    time to say so, and is started again.
    """
    boots = _before(spool)
    for event in _newest_first(spool, boots[-1].boot_id, EVENT) if boots else ():
        assert isinstance(event, UnitEvent)
        if _was_stopped(event) or event.kind is EventKind.MAYDAY_CANCELLED:
            return False
        if event.kind is EventKind.MAYDAY:
            return True
    return False


def position_rate_before(spool: Spool, now_mono_ns: int) -> float | None:
    """The rate that the station has set since the unit was switched on, where its agent was not
    stopped since: of another incident, a rate that nobody remembers would be worse than the usual.

    Monotonic time begins anew when a machine is switched on: what was said at a later time than the
    start that followed it was said before that.
    """
    began_ns = now_mono_ns
    for boot in reversed(_before(spool)):
        events = list(_newest_first(spool, boot.boot_id, EVENT))
        if not events or _was_stopped(events[0]):
            return None
        for answer in (*_newest_first(spool, boot.boot_id, REPLY), events[-1]):
            if answer.header.t_mono_ns > began_ns:
                return None
            rate_hz = position_rate_of(answer) if isinstance(answer, CommandReply) else None
            if rate_hz is not None:
                return rate_hz
        began_ns = events[-1].header.t_mono_ns
    return None


def answers_before(spool: Spool) -> list[CommandReply]:
    """What this unit has answered to commands, oldest first, so that it does none of them again."""
    answers: list[CommandReply] = []
    for boot in reversed(_boots(spool)):
        for answer in _newest_first(spool, boot.boot_id, REPLY):
            assert isinstance(answer, CommandReply)
            answers.append(answer)
            if len(answers) == 2 * REMEMBERED:  # a command has one or two, seldom more
                return answers[::-1]
    return answers[::-1]


def _was_stopped(event: Message) -> bool:
    """In order, so that the unit starts afresh."""
    return isinstance(event, UnitEvent) and event.is_stop_in_order


def _before(spool: Spool) -> list[JournalBoot]:
    return [boot for boot in _boots(spool) if boot.boot_id != spool.boot_id]


def _boots(spool: Spool) -> tuple[JournalBoot, ...]:
    """None where the disk does not let them be read: the unit starts all the same."""
    try:
        return spool.boots()
    except StoreError as error:
        logger.warning("what was said before this start is not known: %s", error)
        return ()


def _newest_first(spool: Spool, boot_id: int, channel: Channel) -> Iterator[Message]:
    """Without what cannot be understood, as after a step back to an older program, and up to where
    the journal is damaged: a unit that would not start for it could say nothing at all.
    """
    try:
        for payload in spool.newest_first(boot_id, channel):
            try:
                yield decode(channel, payload)
            except WireError as error:
                logger.warning("in the journal: %s", error)
    except StoreError as error:
        logger.warning("not all that was said before this start is known: %s", error)
