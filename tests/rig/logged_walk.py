"""A short incident as a log has it, its decisions with a change, and its archive."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path

import msgspec

from base_station.core.events import event_of
from base_station.replay.playback import Archive, Decision
from base_station.storage.checkpoints import Checkpoints
from shared.channels import channel_of
from shared.codec import encode
from shared.messages import STATION_ID, EventKind, FusedPosition
from shared.messages.station import Assign, OpenIncident
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Record, Script

DURATION_S = 120
MAYDAY_S = 60
Change = Callable[[Decision], Decision]  # of a decision that a log has


@cache
def walk_with_mayday() -> tuple[Record, ...]:
    """Two minutes' walk to the north at 1 m/s, with a mayday after one."""
    script = Script()
    script.register("FF-01")
    script.act(Assign("FF-01", "p1", "Ada", "red", "leader"))
    script.act(OpenIncident("i1", "Mill Lane"))
    for second in range(DURATION_S):
        script.now_s += 1.0
        script.position("FF-01", 1.0 * second, 0.0)
        if second == MAYDAY_S:
            script.event("FF-01", EventKind.MAYDAY)
        script.tick()
    return tuple(script.records)


def archive(records: Sequence[Record], folder: Path) -> Archive:
    def from_time(t_ns: int) -> Iterable[Record]:
        return (record for record in records if record[0] >= t_ns)

    return Archive(from_time, Checkpoints(folder), make_pipeline)


def logged(
    change: Change = lambda decision: decision, records: Iterable[Record] | None = None
) -> Iterator[Record]:
    """Records with the decisions that follow from them."""
    pipeline = make_pipeline()
    for t_ns, key, payload in records or walk_with_mayday():
        yield t_ns, key, payload
        for output in pipeline.step(event_of(t_ns, key, payload)):
            if isinstance(output, Decision):
                reported = change(output)
                yield t_ns, channel_of(reported).key(STATION_ID), encode(reported)


def north(by_m: float) -> Change:
    """Change that moves every position beyond 50 m further north."""

    def move(decision: Decision) -> Decision:
        if isinstance(decision, FusedPosition) and decision.north_m > 50.0:
            return msgspec.structs.replace(decision, north_m=decision.north_m + by_m)
        return decision

    return move
