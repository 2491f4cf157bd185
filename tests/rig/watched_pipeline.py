"""A script of events on whose pipeline a console looks."""

from __future__ import annotations

import math

import msgspec

from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import Output
from base_station.core.pipeline import StationPipeline
from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.ports import Trails
from base_station.storage.db.known_people import person_lookup
from base_station.views.wire import BeaconView, Delta, PinView, Snapshot, TrailPoint, UnitView
from shared.channels import POSITION, TICK, backfilled_key
from shared.codec import encode
from shared.messages import STATION_ID, Position
from tests.rig import message_factory
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Script

# As the page thins out what it draws.
STEP_MS, STEP_M, REST_MS = 1000, 0.5, 15_000


class Console:
    """A ``LiveSink`` that follows as the page does (``console/src/live/state.ts``)."""

    def __init__(self) -> None:
        self.units: dict[str, UnitView] = {}
        self.pins: tuple[PinView, ...] = ()
        self.beacons: tuple[BeaconView, ...] = ()
        self.trails: dict[str, list[TrailPoint]] = {}

    def delta(self, delta: Delta) -> None:
        for unit in delta.units:
            self.units[unit.unit_id] = unit
            if unit.position is not None:
                at = unit.position
                self._go_on(unit.unit_id, TrailPoint(at.t_ms, at.north_m, at.east_m, at.floor))
        self.trails |= {unit_id: _read(points) for unit_id, points in delta.trails.items()}
        self.pins = self.pins if delta.pins is None else delta.pins
        self.beacons = self.beacons if delta.beacons is None else delta.beacons

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        self.units = {unit.unit_id: unit for unit in snapshot.units}
        self.pins, self.beacons = snapshot.pins, snapshot.beacons
        self.trails = {unit_id: _read(points) for unit_id, points in trails.items()}

    def _go_on(self, unit_id: str, point: TrailPoint) -> None:
        trail = self.trails.setdefault(unit_id, [])
        if trail:
            passed_ms = point.t_ms - trail[-1].t_ms
            moved = apart_m(point, trail[-1]) >= STEP_M or point.floor != trail[-1].floor
            if passed_ms < (STEP_MS if moved else REST_MS):
                return
        trail.append(point)


def _read(points: msgspec.Raw) -> list[TrailPoint]:
    return msgspec.json.decode(points, type=list[TrailPoint])


def apart_m(one: TrailPoint, other: TrailPoint) -> float:
    return math.dist((one.north_m, one.east_m), (other.north_m, other.east_m))


class WatchedScript(Script):
    """Consoles are told after every event; units that are ``away`` write into their journals."""

    def __init__(self, pipeline: StationPipeline | None = None) -> None:
        super().__init__(pipeline)
        self.console = Console()
        self.publisher = ConsolePublisher(self.pipeline, self.console, person_lookup({}))
        self.away: set[str] = set()
        self.journal: list[Position] = []

    def record(self, key: str, payload: bytes) -> list[Output]:
        outputs = super().record(key, payload)
        self.publisher.mark_changed(outputs)
        self.publisher.publish_delta(key == TICK.key(STATION_ID))
        return outputs

    def position(
        self, unit_id: str, north_m: float, east_m: float, **changes: object
    ) -> list[Output]:
        if unit_id not in self.away:
            return super().position(unit_id, north_m, east_m, **changes)
        walked = {"north_m": north_m, "east_m": east_m, **changes}
        self.journal.append(message_factory.position(self.header(unit_id), **walked))
        return []

    def backfill(self, count: int) -> None:
        """The station is given the newest of what it missed."""
        for _ in range(min(count, len(self.journal))):
            late = self.journal.pop()
            self.record(backfilled_key(late.header.unit_id, POSITION.suffix), encode(late))

    def restarted(self) -> WatchedScript:
        """Another station that goes on from here; who looks at it has just opened the page."""
        other = WatchedScript(make_pipeline(read_checkpoint(self.pipeline.checkpoint())))
        other.now_s, other._seqs = self.now_s, dict(self._seqs)
        other.away, other.journal = set(self.away), list(self.journal)
        other.publisher.reset()
        return other

    def joined(self) -> Console:
        """A console that somebody opens now."""
        console = Console()
        console.reset(*self.publisher.snapshot())
        return console
