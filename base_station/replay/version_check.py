"""Check that a replay decides as the live station did: another version of the program may not.

Where a person was forgotten, or records are missing, the same program decides otherwise, too: the
records behind that prove nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import islice, takewhile

from base_station.core.erasure.erasure import is_inserted
from base_station.core.events import Received, event_of
from base_station.core.pipeline import StationPipeline
from base_station.core.state import ERASED_TEXT
from base_station.replay.playback import Comparison, Decision, Playback, Record
from shared.channels import channel_of
from shared.codec import decode, encode
from shared.coded_text import coded
from shared.messages import AlarmChange, FusedPosition, Message, OperatorAction

FIRST = 10_000  # records: to look at them takes half a second
OF_INCIDENT = 100_000  # records, of which a few are looked at now and then
SEEN_M = 0.5  # on the plan
DIFFERS = coded(
    "replay-version",
    "this version of Muster decides otherwise than the station did: places and alarms of a "
    "replay may differ from what was shown then, which is in the log",
)


def decisions_differ(records: Iterable[Record], pipeline: StationPipeline) -> bool:
    """True if decisions at the beginning of a log differ visibly."""
    return any(_differences(islice(records, FIRST), pipeline))


class VersionCheck:
    """Check of the next records of a playback, one at a time."""

    def __init__(self, playback: Playback, until_ns: int) -> None:
        self._playback = playback
        self._until_ns = until_ns
        self._found: Iterator[bool] | None = None

    def check_next_record(self) -> bool | None:
        """True if the pipeline decides otherwise at the next record than it did live; None: there
        is no record, or it cannot be read now.
        """
        if self._found is None:
            self._found = self._begin()
        return None if self._found is None else next(self._found, None)

    def _begin(self) -> Iterator[bool] | None:
        branch = self._playback.branch()
        if branch is None:
            return None
        pipeline, records = branch
        within = takewhile(lambda record: record[0] <= self._until_ns, records)
        return _differences(islice(within, OF_INCIDENT), pipeline)


def _differences(records: Iterable[Record], pipeline: StationPipeline) -> Iterator[bool]:
    """For each record, whether the decision of now differs visibly."""
    comparison = Comparison(pipeline)
    for record in _comparable(records, pipeline):
        found = comparison.step(record)
        yield (
            found is not None
            and found.logged is not None
            and found.replayed is not None
            and _is_seen(found.logged, _as_logged(found.replayed))
        )


def _comparable(records: Iterable[Record], pipeline: StationPipeline) -> Iterator[Record]:
    """Records that can be compared: undecided by the pipeline, and before any gap.  Decisions are
    numbered from the first event on.
    """
    begun = numbered = pipeline.state.seq
    for record in records:
        event = event_of(*record)
        message = event.message if isinstance(event, Received) else None
        if isinstance(message, Decision):
            header = message.header
            if header.boot_id == pipeline.state.boot_id and header.seq <= begun:
                continue
            numbered += 1
            if (header.boot_id, header.seq) != (pipeline.state.boot_id, numbered):
                return
        elif isinstance(message, OperatorAction) and (
            ERASED_TEXT.encode() in record[2] or is_inserted(message)
        ):
            return
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
