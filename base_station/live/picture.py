"""Keeps consoles up to date with a pipeline: which units, alarms and commands changed since the
last delta, and when only a whole new snapshot will do.  Live and replay both draw through it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from base_station.events import (
    CommandTouched,
    NamesForgotten,
    Output,
    PinsTouched,
    TrailFilled,
    UnitTouched,
)
from base_station.live.drawn_trails import DrawnTrails
from base_station.live.sinks import LiveSink, PhotoUrls, Trails
from base_station.pipeline import StationPipeline
from base_station.views.station import (
    StationFacts,
    alarm_view,
    beacon_views,
    command_view,
    health_view,
    pin_views,
    snapshot,
)
from base_station.views.units import unit_views
from base_station.views.wire import Delta, ReplayView, Snapshot
from shared.clock import NS_PER_MS
from shared.messages import AlarmChange, FusedPosition

FILLED_A_TURN = 8  # trails whose past was filled in are told whole: so many with one delta


class Picture:
    """What the consoles were told of one pipeline."""

    def __init__(self, pipeline: StationPipeline, sink: LiveSink, photo_urls: PhotoUrls) -> None:
        self._sink = sink
        self._photo_urls = photo_urls
        self._seq = 0
        self.facts = StationFacts()  # of the station's surroundings, as last measured
        self.show(pipeline)

    def show(self, pipeline: StationPipeline) -> None:
        """Go on with another pipeline; the next ``flush`` or ``reset`` tells it."""
        self._pipeline = pipeline
        self._trails = DrawnTrails()
        self._units: dict[str, None] = {}  # an ordered set
        self._later: dict[str, None] = {}  # told with the station's health, or when touched
        self._alarms: list[AlarmChange] = []
        self._commands: dict[str, None] = {}
        self._filled: dict[str, None] = {}  # since trails were last told
        self._untold: dict[str, None] = {}  # filled trails that are to be told now
        self._pins_changed = False
        self._forgotten = False  # somebody, since consoles were told everything
        self._frame = self._frame_now()

    def note(self, outputs: Sequence[Output]) -> None:
        for output in outputs:
            if isinstance(output, UnitTouched):
                (self._units if output.soon else self._later)[output.unit_id] = None
            elif isinstance(output, FusedPosition):
                pass  # its unit is touched
            elif isinstance(output, CommandTouched):
                self._commands[output.command_id] = None
            elif isinstance(output, TrailFilled):
                self._filled[output.unit_id] = None
            elif isinstance(output, PinsTouched):
                self._pins_changed = True
            elif isinstance(output, NamesForgotten):
                self._forgotten = True
            elif isinstance(output, AlarmChange):
                self._alarms.append(output)
                if output.unit_id:
                    self._units[output.unit_id] = None

    def flush(self, health: bool = False, replay: ReplayView | None = None) -> None:
        """Tell what changed, and when asked for, how the station is."""
        frames = zip(self._frame_now(), self._frame, strict=True)
        if self._forgotten or any(now is not told for now, told in frames):
            self.reset(replay)
            return
        if health or replay:
            self._units.update(self._later)
        if health or self._pins_changed:
            self._untold.update(self._filled)
            self._filled.clear()
        if not (self._has_news or health or replay):
            return
        state = self._pipeline.state
        for unit_id in self._units:
            self._later.pop(unit_id, None)
            self._trails.keep_up(state.units[unit_id])
        self._seq += 1
        delta = Delta(
            seq=self._seq,
            now_ms=state.t_ns // NS_PER_MS,
            units=unit_views(state, map(state.units.__getitem__, self._units), self._photo_urls),
            alarms=tuple(map(alarm_view, self._alarms)),
            commands=tuple(
                command_view(state.commands[command_id])
                for command_id in self._commands
                if command_id in state.commands
            ),
            trails=self._filled_trails(),
            pins=pin_views(state) if self._pins_changed else None,
            beacons=beacon_views(state) if self._pins_changed else None,
            health=health_view(state, self.facts) if health else None,
            replay=replay,
        )
        self._units.clear()
        self._alarms.clear()
        self._commands.clear()
        self._pins_changed = False
        self._sink.delta(delta)

    @property
    def is_urgent(self) -> bool:
        """More than where units are and how they do has changed."""
        return bool(self._alarms or self._commands or self._pins_changed)

    @property
    def _has_news(self) -> bool:
        return bool(self._units or self._untold) or self.is_urgent

    def reset(self, replay: ReplayView | None = None) -> None:
        """Everybody begins again."""
        self._frame = self._frame_now()
        self._units.clear()
        self._later.clear()
        self._alarms.clear()
        self._commands.clear()
        self._filled.clear()
        self._untold.clear()
        self._pins_changed = self._forgotten = False
        self._sink.reset(*self._whole(replay))

    def whole(self, replay: ReplayView | None = None) -> tuple[Snapshot, Trails]:
        """For one console, after what was noted so far was told to all."""
        self.flush(replay=replay)
        return self._whole(replay)

    def _filled_trails(self) -> Mapping[str, msgspec.Raw]:
        """Some at a time, and those of a second together: a gap is filled over seconds."""
        units = self._pipeline.state.units
        now = list(self._untold)[:FILLED_A_TURN]
        for unit_id in now:
            del self._untold[unit_id]
        return {unit_id: self._trails.of(units[unit_id]) for unit_id in now}

    def _whole(self, replay: ReplayView | None) -> tuple[Snapshot, Trails]:
        state = self._pipeline.state
        shown = snapshot(state, self._seq, self.facts, self._photo_urls, replay)
        return shown, self._trails.all(state.units.values())

    def _frame_now(self) -> tuple[object, ...]:
        """What deltas do not carry; replaced whole by the pipeline when it changes."""
        state = self._pipeline.state
        return state.incident, state.plan, state.anchor
