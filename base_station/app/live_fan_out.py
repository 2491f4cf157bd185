"""Passes snapshots, deltas and projections on to consoles or tables, and to forwarders."""

from __future__ import annotations

from base_station.engine.ports import LiveSink, LiveSource, Trails
from base_station.forwarders.running import Forwarders
from base_station.storage.projection import Projection, ProjectionSink
from base_station.views.wire import Delta, Snapshot


class LiveFanOut:
    """``LiveSink`` that passes on to the console hub first, then to the forwarders."""

    def __init__(self, hub: LiveSink, forwarders: Forwarders) -> None:
        self._hub = hub
        self._forwarders = forwarders

    def delta(self, delta: Delta) -> None:
        self._hub.delta(delta)
        self._forwarders.delta(delta)

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        self._hub.reset(snapshot, trails)
        self._forwarders.reset(snapshot)

    def start(self, source: LiveSource) -> None:
        """Start the forwarders with the present picture."""
        if not self._forwarders.is_empty:  # a picture of everybody costs the engine something
            source.request_snapshot(lambda snapshot, _: self._forwarders.reset(snapshot))
        self._forwarders.start()


class ProjectionFanOut:
    """``ProjectionSink`` that passes on to the tables first, then to the forwarders."""

    def __init__(self, tables: ProjectionSink, forwarders: Forwarders) -> None:
        self._tables = tables
        self._forwarders = forwarders

    def project(self, projection: Projection) -> None:
        self._tables.project(projection)
        self._forwarders.project(projection)

    def problem(self) -> str:
        return self._tables.problem()
