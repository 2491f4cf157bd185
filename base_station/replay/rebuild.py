"""Makes the queryable projections again from the log."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from base_station.core.events import event_of
from base_station.core.pipeline import StationPipeline
from base_station.engine.projector import Projector
from base_station.storage.projection import Projection
from shared.clock import NS_PER_S

_STEP_NS = 10 * NS_PER_S  # of log time between two projections

Record = tuple[int, str, bytes]  # station time, key, payload


def project_log(
    records: Iterable[Record],
    pipeline: StationPipeline,
    write: Callable[[Projection], None],
    on_progress: Callable[[int], None],
) -> int:
    """Step a whole log through a new pipeline and write its projections.

    ``on_progress`` receives the station time reached.  Gives the number of records.
    """
    projector = Projector()
    next_ns, count, t_ns = 0, 0, 0
    for t_ns, key, payload in records:
        event = event_of(t_ns, key, payload)
        projector.note(event, pipeline.step(event))
        count += 1
        if t_ns >= next_ns:
            next_ns = t_ns + _STEP_NS
            _write(projector, t_ns, write)
            on_progress(t_ns)
    _write(projector, t_ns, write)
    on_progress(t_ns)
    return count


def _write(projector: Projector, t_ns: int, write: Callable[[Projection], None]) -> None:
    projection = projector.take(t_ns)
    if projection is not None:
        write(projection)
