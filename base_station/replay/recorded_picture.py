"""Picture of a console at some time of a recording, and its changes since it was published."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from base_station.core.state.message_stream import LOST_AFTER_S, STALE_AFTER_S
from base_station.engine.ports import Trails
from base_station.replay.console_recording import Frame
from base_station.site.max_travel import max_travel_m
from base_station.storage.db.known_people import PersonLookup
from base_station.views.recorded import (
    RecordedDelta,
    named_alarm,
    named_beacon,
    named_command,
    named_dispatch,
    named_incident,
    named_pin,
    named_unit,
)
from base_station.views.station import RESOLVED_SHOWN
from base_station.views.wire import (
    AlarmView,
    CommandView,
    Delta,
    HealthView,
    ReplayView,
    Snapshot,
    TrailPoint,
    UnitView,
    encoded_trail,
)

_EMPTY = Snapshot(
    seq=0,
    now_ms=0,
    incident=None,
    units=(),
    alarms=(),
    commands=(),
    pins=(),
    beacons=(),
    external=(),
    plan=None,
    anchor=None,
    health=HealthView((), 0, 0, 0, 0, 0, 0.0, insecure=False),
    replay=None,
)
_TRAILS_PER_DELTA = 8  # of those that a console cannot go on with by itself


class RecordedPicture:
    """``apply`` frames to it in their order."""

    def __init__(self) -> None:
        self._apart = _EMPTY  # parts that deltas do not carry
        self._units: dict[str, UnitView] = {}
        self._alarms: dict[str, AlarmView] = {}  # the resolved ones in the order of resolving
        self._commands: dict[str, CommandView] = {}
        self._trails: dict[str, _RecordedTrail] = {}
        self._changed_units: dict[str, None] = {}  # an ordered set
        self._changed_alarms: dict[str, None] = {}
        self._changed_commands: dict[str, None] = {}
        self._due_trails: dict[str, None] = {}
        self._pins_changed = self._external_changed = False
        self.now_ms = 0
        self.is_new = True  # consoles need a snapshot

    def apply(self, frame: Frame) -> None:
        message = frame.message
        if isinstance(message, Snapshot):
            self._take_snapshot(message, frame.trails)
        else:
            self._take_delta(message)
        self.now_ms = message.now_ms

    def age(self) -> None:
        """Advance the time over a gap in the records: all units age."""
        self._changed_units |= dict.fromkeys(self._units)

    def delta(
        self, seq: int, now_ms: int, people: PersonLookup, replay: ReplayView, *, whole: bool
    ) -> Delta:
        """Changes since the last one; ``now_ms``: later than the picture in a gap."""
        apart = self._apart
        delta = Delta(
            seq=seq,
            now_ms=now_ms,
            units=tuple(
                self._shown(self._units[one], now_ms, people) for one in self._changed_units
            ),
            alarms=tuple(named_alarm(self._alarms[one], people) for one in self._changed_alarms),
            commands=tuple(
                named_command(self._commands[one], people) for one in self._changed_commands
            ),
            trails=self._take_due_trails(),
            pins=tuple(named_pin(one, people) for one in apart.pins)
            if self._pins_changed
            else None,
            beacons=tuple(named_beacon(one, people) for one in apart.beacons)
            if self._pins_changed
            else None,
            external=apart.external if self._external_changed else None,
            health=apart.health if whole else None,
            replay=replay,
        )
        self._forget_changes()
        return delta

    def snapshot(
        self, seq: int, now_ms: int, people: PersonLookup, replay: ReplayView
    ) -> tuple[Snapshot, Trails]:
        apart = self._apart
        alarms = self._alarms.values()
        resolved = [one for one in alarms if one.state == "resolved"]
        still_open = [one for one in alarms if one.state != "resolved"]
        shown = msgspec.structs.replace(
            apart,
            seq=seq,
            now_ms=now_ms,
            incident=None if apart.incident is None else named_incident(apart.incident, people),
            incidents=tuple(named_incident(one, people) for one in apart.incidents),
            units=tuple(self._shown(one, now_ms, people) for one in self._units.values()),
            alarms=tuple(
                named_alarm(one, people) for one in (*still_open, *resolved[-RESOLVED_SHOWN:])
            ),
            commands=tuple(named_command(one, people) for one in self._commands.values()),
            pins=tuple(named_pin(one, people) for one in apart.pins),
            beacons=tuple(named_beacon(one, people) for one in apart.beacons),
            dispatches=tuple(named_dispatch(one, people) for one in apart.dispatches),
            replay=replay,
        )
        return shown, {unit_id: trail.whole() for unit_id, trail in self._trails.items()}

    def note_shown(self) -> None:
        """All consoles were given a snapshot."""
        self.is_new = False
        self._due_trails.clear()
        self._forget_changes()

    def _take_snapshot(self, snapshot: Snapshot, trails: Trails) -> None:
        was = self._apart
        names = ("incident", "incidents", "plan", "anchor", "sites", "dispatches")
        is_other = any(getattr(was, name) != getattr(snapshot, name) for name in names)
        self.is_new = self.is_new or is_other
        changed = [one for one in snapshot.units if self._units.get(one.unit_id) != one]
        self._changed_units |= {one.unit_id: None for one in changed}
        self._apart = snapshot
        self._units = {one.unit_id: one for one in snapshot.units}
        self._alarms = {one.alarm_id: one for one in snapshot.alarms}
        self._commands = {one.command_id: one for one in snapshot.commands}
        self._changed_alarms = _still_in(self._changed_alarms, self._alarms)
        self._changed_commands = _still_in(self._changed_commands, self._commands)
        self._trails = {unit_id: _RecordedTrail(points) for unit_id, points in trails.items()}

    def _take_delta(self, delta: RecordedDelta) -> None:
        for unit in delta.units:
            self._units[unit.unit_id] = unit
            self._changed_units[unit.unit_id] = None
        for alarm in delta.alarms:
            if alarm.state == "resolved":
                self._alarms.pop(alarm.alarm_id, None)
            self._alarms[alarm.alarm_id] = alarm
            self._changed_alarms[alarm.alarm_id] = None
        for command in delta.commands:
            self._commands[command.command_id] = command
            self._changed_commands[command.command_id] = None
        self._extend_trails(delta)
        parts = ("pins", "beacons", "external", "health")
        changed = {name: getattr(delta, name) for name in parts if getattr(delta, name) is not None}
        self._apart = msgspec.structs.replace(self._apart, **changed)
        self._pins_changed = self._pins_changed or delta.pins is not None
        self._external_changed = self._external_changed or delta.external is not None

    def _extend_trails(self, delta: RecordedDelta) -> None:
        for unit_id, points in delta.points.items():
            trail = self._trails.setdefault(unit_id, _RecordedTrail(msgspec.Raw(b"[]")))
            trail.points += points
            trail.unpublished += len(points)
            if trail.unpublished > 1:  # a console makes one of what it is shown of the unit
                self._due_trails[unit_id] = None
        for unit_id, points_raw in delta.trails.items():
            self._trails[unit_id] = _RecordedTrail(points_raw.copy())
            self._due_trails[unit_id] = None

    def _take_due_trails(self) -> Mapping[str, msgspec.Raw]:
        now = list(self._due_trails)[:_TRAILS_PER_DELTA]
        for unit_id in now:
            del self._due_trails[unit_id]
        return {
            unit_id: self._trails[unit_id].whole() for unit_id in now if unit_id in self._trails
        }

    def _forget_changes(self) -> None:
        for unit_id in self._changed_units:
            if unit_id in self._trails:
                self._trails[unit_id].unpublished = 0
        self._changed_units.clear()
        self._changed_alarms.clear()
        self._changed_commands.clear()
        self._pins_changed = self._external_changed = False

    def _shown(self, unit: UnitView, now_ms: int, people: PersonLookup) -> UnitView:
        return named_unit(_aged(unit, self.now_ms, now_ms), people)


class _RecordedTrail:
    """The points of a keyframe as they were encoded, and those behind them."""

    def __init__(self, keyframe: msgspec.Raw) -> None:
        self._keyframe = bytes(keyframe)
        self.points: list[TrailPoint] = []
        self.unpublished = 0  # of the points

    def whole(self) -> msgspec.Raw:
        if not self.points:
            return msgspec.Raw(self._keyframe)
        joint = b"" if self._keyframe == b"[]" else b","
        return msgspec.Raw(self._keyframe[:-1] + joint + encoded_trail(self.points)[1:])


def _still_in(ids: Mapping[str, None], there: Mapping[str, object]) -> dict[str, None]:
    return {one: None for one in ids if one in there}


def _aged(unit: UnitView, then_ms: int, now_ms: int) -> UnitView:
    """As it is shown where nothing is recorded of the time since, as live: its link and the region
    of its position, which does not heed walls here.
    """
    if now_ms <= then_ms or unit.last_heard_ms is None:
        return unit
    silent_s = (now_ms - unit.last_heard_ms) / 1e3
    link = (
        "lost" if silent_s >= LOST_AFTER_S else "stale" if silent_s >= STALE_AFTER_S else unit.link
    )
    position = unit.position
    if position is not None:
        ages_s = (now_ms - position.t_ms) / 1e3, (then_ms - position.t_ms) / 1e3
        wider_m = max_travel_m(ages_s[0]) - max_travel_m(ages_s[1])
        position = msgspec.structs.replace(
            position,
            ellipse_major_m=position.ellipse_major_m + wider_m,
            ellipse_minor_m=position.ellipse_minor_m + wider_m,
            reach=position.reach if wider_m == 0.0 else (),
        )
    return msgspec.structs.replace(unit, link=link, position=position)
