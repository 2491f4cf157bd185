"""Fusion again, over a log with the positions of another tracker in it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

import msgspec

from base_station.core.events import Output
from base_station.replay.playback import Archive, Playback
from base_station.replay.rerun.black_boxes import Run
from base_station.replay.rerun.comparison import RaisedAlarm
from base_station.replay.rerun.retracked_run import RetrackedRun
from base_station.replay.rerun.substitution import Substitution
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S
from shared.messages import AlarmChange, AlarmState, FusedPosition


class RerunResult(msgspec.Struct, frozen=True):
    trails: dict[str, list[TrackSample]]  # by unit: a position a second
    alarms: list[RaisedAlarm]
    counts: dict[str, tuple[int, int]]  # by unit: positions sent, and those out of a recording


def fuse_again(
    archive: Archive,
    runs: Mapping[Run, RetrackedRun],
    from_ns: int,
    until_ns: int,
    on_progress: Callable[[float], None],
) -> RerunResult:
    """Step the incident between two station times with the messages of ``runs``."""
    substitution = Substitution(runs, from_ns, until_ns)
    playback = Playback(replace(archive, open_log=substitution.log(archive.open_log), own=None))
    for _ in playback.seek(from_ns - 1):
        pass
    collected = _Collected(from_ns, until_ns)
    while (outputs := playback.advance(until_ns)) is not None:
        collected.take(outputs)
        on_progress(min((playback.at_ns - from_ns) / max(until_ns - from_ns, 1), 1.0))
    counts = {
        unit_id: (count, substitution.retracked.get(unit_id, 0))
        for unit_id, count in substitution.positions.items()
    }
    return RerunResult(collected.sorted_trails(), list(collected.alarms.values()), counts)


class _Collected:
    def __init__(self, from_ns: int, until_ns: int) -> None:
        self._from_ns = from_ns
        self._until_ns = until_ns
        self._trails: dict[str, dict[int, TrackSample]] = {}  # by unit and second
        self.alarms: dict[str, RaisedAlarm] = {}

    def take(self, outputs: Iterable[Output]) -> None:
        for output in outputs:
            if isinstance(output, FusedPosition):
                if self._from_ns <= output.t_meas_ns <= self._until_ns:
                    trail = self._trails.setdefault(output.unit_id, {})
                    trail.setdefault(output.t_meas_ns // NS_PER_S, _sample(output))
            elif isinstance(output, AlarmChange) and output.state is AlarmState.RAISED:
                self.alarms.setdefault(
                    output.alarm_id,
                    RaisedAlarm(output.rule, output.unit_id, output.raised_ns),
                )

    def sorted_trails(self) -> dict[str, list[TrackSample]]:
        return {
            unit_id: [trail[second] for second in sorted(trail)]
            for unit_id, trail in sorted(self._trails.items())
        }


def _sample(fused: FusedPosition) -> TrackSample:
    return TrackSample(
        t_ns=fused.t_meas_ns,
        north_m=fused.north_m,
        east_m=fused.east_m,
        down_m=fused.down_m,
        std_north_m=fused.std_north_m,
        std_east_m=fused.std_east_m,
        std_down_m=fused.std_down_m,
        heading_rad=fused.heading_rad,
        floor=fused.floor,
        quality=fused.quality.name.lower(),
    )
