"""Forwarders of a running station."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from base_station.forwarders.interface import Forwarder, Surroundings
from base_station.forwarders.registry import FORWARDERS
from base_station.storage.projection import Projection
from base_station.views.wire import Delta, ForwarderView, Snapshot
from shared.messages.station import ReportProblem

_PART = "forwarder-"


class Forwarders:
    """All forwarders of the settings; each gets the snapshots and deltas of consoles."""

    def __init__(self, forwarders: Sequence[Forwarder]) -> None:
        self._forwarders = tuple(forwarders)

    @property
    def is_empty(self) -> bool:
        return not self._forwarders

    def delta(self, delta: Delta) -> None:
        for forwarder in self._forwarders:
            forwarder.delta(delta)

    def reset(self, snapshot: Snapshot) -> None:
        for forwarder in self._forwarders:
            forwarder.reset(snapshot)

    def project(self, projection: Projection) -> None:
        for forwarder in self._forwarders:
            forwarder.project(projection)

    def start(self) -> None:
        for forwarder in self._forwarders:
            forwarder.start()

    def close(self) -> None:
        for forwarder in self._forwarders:
            forwarder.close()

    def views(self) -> tuple[ForwarderView, ...]:
        return tuple(forwarder.view() for forwarder in self._forwarders)

    def changes(self, known: Mapping[str, str]) -> Iterator[ReportProblem]:
        """Reports of connections that have been away for long, and of those that are back.

        ``known``: problems that stand reported, by part; those of a connection that an earlier run
        had end too.
        """
        now = {f"{_PART}{one.view().name}": one.problem() for one in self._forwarders}
        for part, text in now.items():
            if text and part not in known:
                yield ReportProblem.of(part, text)
        for part in known:
            if part.startswith(_PART) and not now.get(part):
                yield ReportProblem(part, "")


def make_forwarders(tables: Mapping[str, Mapping[str, Any]], around: Surroundings) -> Forwarders:
    """Create the forwarders.  ``tables``: settings of each kind, by table and name."""
    return Forwarders(
        [
            kind.make(name, settings, around)
            for kind in FORWARDERS
            for name, settings in tables[kind.table].items()
        ]
    )
