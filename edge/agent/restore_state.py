"""State restored from the journal at a start: a latched mayday, answers to commands, the
position rate that one of them set.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from itertools import groupby, islice
from operator import itemgetter

from edge.agent.command_handler import REMEMBERED, position_rate_of
from edge.storage.journal.journal import EarlierAlert, Journal
from shared.channels import EVENT, REPLY, Channel
from shared.codec import decode
from shared.errors import StoreError, WireError
from shared.messages import CommandReply, EventKind, Message, UnitEvent

logger = logging.getLogger(__name__)


def mayday_before(journal: Journal) -> bool:
    """Return True if a mayday was latched when the boot before this one ended suddenly.

    A unit that was stopped in order has logged that, and starts without a mayday.  One that failed
    may have logged it too, and is started again.
    """
    for event in next(_boots(journal, EVENT), ()):
        assert isinstance(event, UnitEvent)
        if event.is_stop_in_order or event.kind is EventKind.MAYDAY_CANCELLED:
            return False
        if event.kind is EventKind.MAYDAY:
            return True
    return False


def position_rate_before(journal: Journal, now_mono_ns: int) -> float | None:
    """Return the rate that the station has set since the unit was switched on, if its agent was not
    stopped since: the rate of an earlier incident must not stay.  Monotonic time restarts when a
    machine is switched on: a message with a later time than the start that follows it is from
    before that.
    """
    if not any(position_rate_of(answer) for answer in _answers(journal)):
        return None  # mostly: then the starts need not be compared one by one
    began_ns = now_mono_ns
    for boot in _boots(journal, EVENT, REPLY):
        messages = list(boot)
        events = [one for one in messages if isinstance(one, UnitEvent)]
        answers = [one for one in messages if isinstance(one, CommandReply)]
        if not events or events[0].is_stop_in_order:
            return None
        for answer in answers:
            if answer.header.t_mono_ns > began_ns:
                return None
            rate_hz = position_rate_of(answer)
            if rate_hz is not None:
                return rate_hz
        if events[-1].header.t_mono_ns > began_ns:
            return None
        began_ns = events[-1].header.t_mono_ns
    return None


def answers_before(journal: Journal) -> list[CommandReply]:
    """Return the unit's earlier answers to commands, oldest first, so that it executes none of them
    again.
    """
    newest = islice(_answers(journal), 2 * REMEMBERED)  # a command has one or two, seldom more
    return [*newest][::-1]


def _answers(journal: Journal) -> Iterator[CommandReply]:
    for boot in _boots(journal, REPLY):
        for answer in boot:
            assert isinstance(answer, CommandReply)
            yield answer


def _boots(journal: Journal, *channels: Channel) -> Iterator[Iterator[Message]]:
    """Yield the messages of each boot on these channels, newest first."""
    for _, messages in groupby(_readable(journal, channels), itemgetter(0)):
        yield _decoded(messages)


def _readable(journal: Journal, channels: tuple[Channel, ...]) -> Iterator[EarlierAlert]:
    """Yield the alerts that can be read from the disk: a unit must start in any case."""
    try:
        yield from journal.earlier_alerts(*channels)
    except StoreError as error:
        logger.warning("the messages before this start could be read only in part: %s", error)


def _decoded(messages: Iterator[EarlierAlert]) -> Iterator[Message]:
    """Yield decoded messages; skip undecodable ones, as after a step back to an older program."""
    for each in messages:
        try:
            yield decode(each.channel, each.payload)
        except WireError as error:
            logger.warning("in the journal: %s", error)
