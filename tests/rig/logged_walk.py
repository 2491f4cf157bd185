"""A short incident as a log has it, and what replays it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path

from base_station.replay.playback import Archive
from base_station.storage.checkpoints import Checkpoints
from shared.messages import EventKind
from shared.messages.station import Assign, OpenIncident
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Record, Script

DURATION_S = 120
MAYDAY_S = 60


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
