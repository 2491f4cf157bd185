"""Whether a replay shows what was shown: another version of the program may decide otherwise."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import islice

from base_station.core.erasure.erasure import inserted_action_id
from base_station.core.events import Received, event_of
from base_station.core.pipeline import StationPipeline
from base_station.core.state import ERASED_TEXT
from base_station.replay.playback import Decision, Record, compare
from shared.channels import channel_of
from shared.codec import decode, encode
from shared.messages import AlarmChange, FusedPosition, Message, OperatorAction
from shared.messages.station import CloseIncident, OpenIncident

FIRST = 10_000  # records: to look at them takes half a second
SEEN_M = 0.5  # on the plan


def decisions_differ(records: Iterable[Record], pipeline: StationPipeline) -> bool:
    """Whether anybody who looks on would see it, at the beginning of a log.

    Where somebody was forgotten, or the log is not there from its beginning, the same program
    decides otherwise, too: what follows tells nothing of it.
    """
    comparable = _comparable(islice(records, FIRST), pipeline)
    return any(
        one.logged is not None
        and one.replayed is not None
        and _is_seen(one.logged, _as_logged(one.replayed))
        for one in compare(comparable, pipeline)
    )


def _comparable(records: Iterable[Record], pipeline: StationPipeline) -> Iterator[Record]:
    """Up to where something is gone: decisions are numbered from the first event on."""
    numbered = 0
    put_in: tuple[str, ...] = ()  # how the ids begin of what forgetting put into the log
    for record in records:
        event = event_of(*record)
        message = event.message if isinstance(event, Received) else None
        if isinstance(message, Decision):
            numbered += 1
            header = message.header
            if (header.boot_id, header.seq) != (pipeline.state.boot_id, numbered):
                return
        elif isinstance(message, OperatorAction):
            if ERASED_TEXT.encode() in record[2] or message.action_id.startswith(put_in):
                return
            if isinstance(message.action, OpenIncident | CloseIncident):
                put_in = (*put_in, inserted_action_id(message.action_id, ""))
        yield record


def _as_logged(decision: Decision) -> Message:
    """In the numbers of the log."""
    return decode(channel_of(decision), encode(decision))


def _is_seen(then: Decision, now: Message) -> bool:
    match then, now:
        case FusedPosition(), FusedPosition():
            apart_m = math.hypot(then.north_m - now.north_m, then.east_m - now.east_m)
            return (then.unit_id, then.floor, then.quality) != (
                now.unit_id,
                now.floor,
                now.quality,
            ) or apart_m > SEEN_M
        case AlarmChange(), AlarmChange():
            return (then.alarm_id, then.state) != (now.alarm_id, now.state)
        case _:
            return True
