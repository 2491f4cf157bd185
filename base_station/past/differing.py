"""Whether a replay shows what was shown: another version of the program may decide otherwise."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import islice

from base_station.past.playback import Decision, Record, compare
from base_station.pipeline import StationPipeline
from shared.channels import channel_of
from shared.codec import decode, encode
from shared.messages import AlarmChange, FusedPosition, Message

FIRST = 10_000  # records: to look at them takes half a second
SEEN_M = 0.5  # on the plan


def shows_otherwise(records: Iterable[Record], pipeline: StationPipeline) -> bool:
    """Whether anybody who looks on would see it, at the beginning of a log."""
    return any(
        one.logged is not None
        and one.replayed is not None
        and _is_seen(one.logged, _as_logged(one.replayed))
        for one in compare(islice(records, FIRST), pipeline)
    )


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
