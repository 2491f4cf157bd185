"""What consoles are told of the station's surroundings, beside what its log says."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol

from base_station.app.resources import Resources
from base_station.clocks.steady import SteadyClock
from base_station.standby.side import Side
from base_station.views.station import StationFacts


class Troubled(Protocol):
    """A part that may have something to say."""

    def problems(self) -> Iterable[str]: ...


def facts_of(
    resources: Resources, clock: SteadyClock, side: Side, others: Sequence[Troubled]
) -> StationFacts:
    certificates = resources.expiry, resources.console_expiry, resources.renewal
    parts: tuple[Troubled, ...] = (clock, *certificates, side, *others)
    problems = [
        *resources.config.standing_problems(),
        *(problem for part in parts for problem in part.problems()),
    ]
    if not resources.router.is_open:
        problems.append("The bus's router is away and is started again; no unit is linked")
    if resources.feed.overflows:
        left_out = resources.feed.overflowed
        problems.append(
            f"Messages come faster than this machine can take them; {left_out} were left out, and "
            "are fetched from the units' journals"
        )
    return StationFacts(
        problems=tuple(problems),
        log_bytes=resources.recorder.log_bytes,
        disk_free_bytes=resources.recorder.disk_free_bytes,
        insecure=bool(resources.config.plain_endpoints()),
        standby=None if side.standing is None else side.standing.view(),
        recordings=resources.recordings.views(),
    )
