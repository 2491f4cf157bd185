"""What was said before this start and must not be forgotten: a mayday, answers to commands, and the
rate of positions that one of them set.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from itertools import groupby, islice
from operator import itemgetter

from edge.commands import REMEMBERED, position_rate_of
from edge.journal.spool import SaidBefore, Spool
from shared.channels import EVENT, REPLY, Channel
from shared.codec import decode
from shared.errors import StoreError, WireError
from shared.messages import CommandReply, EventKind, Message, UnitEvent

logger = logging.getLogger(__name__)


def mayday_before(spool: Spool) -> bool:
    """Whether a mayday was latched when the boot before this one came to a sudden end.

    A unit that was stopped in order has said so, and starts afresh; one that has failed had the
    time to say so, and is started again.
    """
    for event in next(_boots(spool, EVENT), ()):
        assert isinstance(event, UnitEvent)
        if event.is_stop_in_order or event.kind is EventKind.MAYDAY_CANCELLED:
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
    if not any(position_rate_of(answer) for answer in _answers(spool)):
        return None  # most often: the starts since then need not be looked at one by one
    began_ns = now_mono_ns
    for boot in _boots(spool, EVENT, REPLY):
        said = list(boot)
        events = [one for one in said if isinstance(one, UnitEvent)]
        answers = [one for one in said if isinstance(one, CommandReply)]
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


def answers_before(spool: Spool) -> list[CommandReply]:
    """What this unit has answered to commands, oldest first, so that it does none of them again."""
    newest = islice(_answers(spool), 2 * REMEMBERED)  # a command has one or two, seldom more
    return [*newest][::-1]


def _answers(spool: Spool) -> Iterator[CommandReply]:
    for boot in _boots(spool, REPLY):
        for answer in boot:
            assert isinstance(answer, CommandReply)
            yield answer


def _boots(spool: Spool, *channels: Channel) -> Iterator[Iterator[Message]]:
    """Those that said something there, and what, each the newest first."""
    for _, said in groupby(_kept(spool, channels), itemgetter(0)):
        yield _understood(said)


def _kept(spool: Spool, channels: tuple[Channel, ...]) -> Iterator[SaidBefore]:
    """As far as the disk lets it be read: a unit that would not start for it could say nothing."""
    try:
        yield from spool.said_before(*channels)
    except StoreError as error:
        logger.warning("not all that was said before this start is known: %s", error)


def _understood(said: Iterator[SaidBefore]) -> Iterator[Message]:
    """Without what cannot be understood, as after a step back to an older program."""
    for each in said:
        try:
            yield decode(each.channel, each.payload)
        except WireError as error:
            logger.warning("in the journal: %s", error)
