"""Health facts of the station's surroundings, which are not in its log."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol

from base_station.app.resources import Resources
from base_station.engine.station_clock import SteadyClock
from base_station.standby.mode import HaMode
from base_station.views.station import StationFacts
from base_station.views.wire import ArchiveView, ForwarderView, RadioView
from shared.coded_text import coded


class ReportsProblems(Protocol):
    """Part of the station that may report problems."""

    def problems(self) -> Iterable[str]: ...


def health_facts(
    resources: Resources,
    clock: SteadyClock,
    ha_mode: HaMode,
    others: Sequence[ReportsProblems],
    *,
    missing: int,
    forwarders: tuple[ForwarderView, ...],
    radio: tuple[RadioView, ...],
    archive: ArchiveView | None,
) -> StationFacts:
    """Collect the facts.  ``missing``: number of messages that no journal has any more."""
    certificates = resources.expiry, resources.console_expiry, resources.renewal
    machine = resources.exposed, resources.router
    network = resources.presence, resources.console_presence
    parts: tuple[ReportsProblems, ...] = (
        clock,
        *certificates,
        *machine,
        *network,
        ha_mode,
        *others,
    )
    problems = [
        *resources.config.configuration_problems(),
        *(problem for part in parts for problem in part.problems()),
    ]
    if resources.feed.overflows:
        left_out = resources.feed.overflowed
        text = coded(
            "messages-left-out",
            "Messages come faster than this machine can take them; {count} were left out, and are "
            "fetched from the units' journals",
            count=left_out,
        )
        problems.append(text)
    return StationFacts(
        problems=tuple(problems),
        log_bytes=resources.recorder.log_bytes,
        disk_free_bytes=resources.recorder.disk_free_bytes,
        left_out=resources.feed.overflowed,
        missing=missing,
        insecure=bool(resources.config.unencrypted_endpoints()),
        standby=None if ha_mode.ha_status is None else ha_mode.ha_status.view(),
        recordings=resources.recordings.views(),
        forwarders=forwarders,
        radio=radio,
        archive=archive,
    )
