"""Console publisher: sends the changes in a pipeline since the last delta, or a whole snapshot.

Live and replay both use it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from operator import is_not

import msgspec

from base_station.core.events import (
    CommandChanged,
    ExternalMarkersChanged,
    NamesErased,
    Output,
    PinsChanged,
    TrailBackfilled,
    UnitChanged,
)
from base_station.core.pipeline import StationPipeline
from base_station.engine.ports import LiveSink, Trails
from base_station.engine.trail_encoder import TrailEncoder
from base_station.storage.db.known_people import PersonLookup
from base_station.views.station import (
    StationFacts,
    alarm_view,
    beacon_views,
    command_view,
    external_views,
    health_view,
    pin_views,
    snapshot,
)
from base_station.views.units import unit_views
from base_station.views.wire import Delta, ReplayView, Snapshot
from shared.clock import NS_PER_MS
from shared.messages import AlarmChange, FusedPosition

TRAILS_PER_DELTA = 8  # backfilled trails are published whole: so many with one delta


class ConsolePublisher:
    """Publisher of one pipeline, with the changes that were not sent to consoles yet."""

    def __init__(self, pipeline: StationPipeline, sink: LiveSink, people: PersonLookup) -> None:
        self._sink = sink
        self._people = people
        self._seq = 0
        self.facts = StationFacts()  # of the station's surroundings, as last measured
        self.use_pipeline(pipeline)

    def use_pipeline(self, pipeline: StationPipeline) -> None:
        """Continue with another pipeline; the next ``publish_delta`` or ``reset`` sends it."""
        self._pipeline = pipeline
        self._trails = TrailEncoder()
        self._units: dict[str, None] = {}  # an ordered set
        self._deferred_units: dict[
            str, None
        ] = {}  # published with the station's health, or when touched
        self._alarms: list[AlarmChange] = []
        self._commands: dict[str, None] = {}
        self._backfilled: dict[str, None] = {}  # since trails were last published
        self._trails_due: dict[str, None] = {}  # backfilled trails that are to be published now
        self._pins_changed = False
        self._external_changed = False
        self._names_erased = False  # of a person, since the last snapshot for consoles
        self._frame = self._frame_now()

    def mark_changed(self, outputs: Sequence[Output]) -> None:
        for output in outputs:
            if isinstance(output, UnitChanged):
                (self._units if output.soon else self._deferred_units)[output.unit_id] = None
            elif isinstance(output, FusedPosition):
                pass  # its unit is touched
            elif isinstance(output, CommandChanged):
                self._commands[output.command_id] = None
            elif isinstance(output, TrailBackfilled):
                self._backfilled[output.unit_id] = None
            elif isinstance(output, PinsChanged):
                self._pins_changed = True
            elif isinstance(output, ExternalMarkersChanged):
                self._external_changed = True
            elif isinstance(output, NamesErased):
                self._names_erased = True
            elif isinstance(output, AlarmChange):
                self._alarms.append(output)
                if output.unit_id:
                    self._units[output.unit_id] = None

    def publish_delta(self, health: bool = False, replay: ReplayView | None = None) -> None:
        """Publish what changed, and on request the station's health."""
        if self._names_erased or self._is_new_frame:
            self.reset(replay)
            return
        if health or replay:
            self._units.update(self._deferred_units)
        if health or self._pins_changed:
            self._trails_due.update(self._backfilled)
            self._backfilled.clear()
        if not (self._has_changes or health or replay):
            return
        state = self._pipeline.state
        for unit_id in self._units:
            self._deferred_units.pop(unit_id, None)
            self._trails.update_if_behind(state.units[unit_id])
        self._seq += 1
        delta = Delta(
            seq=self._seq,
            now_ms=state.t_ns // NS_PER_MS,
            units=unit_views(state, map(state.units.__getitem__, self._units), self._people),
            alarms=tuple(alarm_view(alarm, self._people) for alarm in self._alarms),
            commands=tuple(
                command_view(state.commands[command_id], self._people)
                for command_id in self._commands
                if command_id in state.commands
            ),
            trails=self._backfilled_trails(),
            pins=pin_views(state, self._people) if self._pins_changed else None,
            beacons=beacon_views(state, self._people) if self._pins_changed else None,
            external=external_views(state) if self._external_changed else None,
            health=health_view(state, self.facts) if health else None,
            replay=replay,
        )
        self._units.clear()
        self._alarms.clear()
        self._commands.clear()
        self._pins_changed = self._external_changed = False
        self._sink.delta(delta)

    @property
    def is_urgent(self) -> bool:
        """True if more changed than positions and readings of units."""
        return bool(self._alarms or self._commands or self._pins_changed)

    @property
    def _has_changes(self) -> bool:
        changed = self._units or self._trails_due or self._external_changed
        return bool(changed) or self.is_urgent

    def reset(self, replay: ReplayView | None = None) -> None:
        """Send a new snapshot to all consoles."""
        self._frame = self._frame_now()
        self._units.clear()
        self._deferred_units.clear()
        self._alarms.clear()
        self._commands.clear()
        self._backfilled.clear()
        self._trails_due.clear()
        self._pins_changed = self._external_changed = self._names_erased = False
        self._sink.reset(*self._new_snapshot(replay))

    def snapshot(self, replay: ReplayView | None = None) -> tuple[Snapshot, Trails]:
        """Snapshot for one console, after pending changes were published to all."""
        self.publish_delta(replay=replay)
        return self._new_snapshot(replay)

    def _backfilled_trails(self) -> Mapping[str, msgspec.Raw]:
        """Return a bounded number of backfilled trails.  Points of a second are sent together, as a
        gap is filled over seconds.
        """
        units = self._pipeline.state.units
        now = list(self._trails_due)[:TRAILS_PER_DELTA]
        for unit_id in now:
            del self._trails_due[unit_id]
        return {unit_id: self._trails.of(units[unit_id]) for unit_id in now}

    def _new_snapshot(self, replay: ReplayView | None) -> tuple[Snapshot, Trails]:
        state = self._pipeline.state
        shown = snapshot(state, self._seq, self.facts, self._people, replay)
        return shown, self._trails.all(state.units.values())

    def _frame_now(self) -> tuple[object, ...]:
        """Parts of the picture that deltas do not carry; the pipeline replaces them as a whole when
        they change.
        """
        state = self._pipeline.state
        sites = state.sites.values()
        grounds = [part for site in sites for part in (site.plan, site.anchor)]
        return (*state.incidents.values(), *grounds, state.dispatches)

    @property
    def _is_new_frame(self) -> bool:
        now = self._frame_now()
        return len(now) != len(self._frame) or any(map(is_not, now, self._frame))
