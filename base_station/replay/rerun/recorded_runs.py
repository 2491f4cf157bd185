"""Recorded runs: the data that a re-run needs of each run of a unit's program, out of the log."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from itertools import pairwise
from statistics import median

import msgspec

from base_station.replay.rerun.black_boxes import Run
from shared.channels import POSITION, STATUS, Channel, backfilled_key
from shared.clock import NS_PER_S
from shared.codec import decode, header_of
from shared.errors import WireError
from shared.mcap_log import LogRecord
from shared.messages import Position

_STATUSES_MAX = 400
_POSITIONS_MAX = 1500  # at the begin: some minutes
_RATE_HZ_MAX = 50.0


class RecordedRun(msgspec.Struct):
    """Times are the unit's monotonic time, unless a name has another."""

    status_ns: list[int] = msgspec.field(default_factory=list)
    positions: list[Position] = msgspec.field(default_factory=list)  # the first ones, by time
    utc_less_mono_ns: int | None = None  # as the unit knew it at its first message; None: not

    @property
    def rate_hz(self) -> float:
        """Positions a second, by the times between the first ones."""
        times_ns = sorted({one.header.t_mono_ns for one in self.positions})
        apart_ns = [later - before for before, later in pairwise(times_ns)]
        return min(round(NS_PER_S / median(apart_ns), 1), _RATE_HZ_MAX) if apart_ns else 5.0


def wanted_keys(unit_ids: Iterable[str], channels: Iterable[Channel]) -> Collection[str]:
    """Keys of these channels, live and out of journals."""
    channels = tuple(channels)
    return {
        key
        for unit_id in unit_ids
        for channel in channels
        for key in (channel.key(unit_id), backfilled_key(unit_id, channel.suffix))
    }


def read_runs(
    records: Iterable[LogRecord], on_progress: Callable[[int], None]
) -> dict[Run, RecordedRun]:
    """One pass over positions and statuses; ``on_progress`` gets the station time reached."""
    runs: dict[Run, RecordedRun] = {}
    for number, (t_ns, key, payload) in enumerate(records):
        if number % 10_000 == 0:
            on_progress(t_ns)
        header = header_of(payload)
        if header is None:
            continue
        run = runs.get((header.unit_id, header.boot_id))
        if run is None:
            run = runs[header.unit_id, header.boot_id] = RecordedRun(
                utc_less_mono_ns=header.t_utc_ns - header.t_mono_ns if header.t_utc_ns else None
            )
        if key.endswith(STATUS.suffix):
            if len(run.status_ns) < _STATUSES_MAX:
                run.status_ns.append(header.t_mono_ns)
        elif len(run.positions) < _POSITIONS_MAX:
            _take_position(run, payload)
    for run in runs.values():
        run.positions.sort(key=lambda one: one.header.t_mono_ns)
    return runs


def _take_position(run: RecordedRun, payload: bytes) -> None:
    try:
        position = decode(POSITION, payload)
    except WireError:
        return
    assert isinstance(position, Position)
    run.positions.append(position)
