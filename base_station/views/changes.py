"""Changed fields of units in place of whole units, and the merging of such messages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, Final

import msgspec

from base_station.views.wire import Delta, FieldDelta, Snapshot, TrailPoint, UnitChange, UnitView

_PLACE = ("t_ms", "north_m", "east_m", "floor")  # of a position; together a point of a trail
_POINT_STEP_MS = 1000  # trails have at most a point a second
# Parts that are published whole, or not at all.
_LATEST: Final = tuple(
    field.name for field in msgspec.structs.fields(FieldDelta) if field.default is None
)
_KEPT_MERGED = 16  # slow consoles that are about as slow get the same


class UnitChanges:
    """State of every unit as all consoles know it, from which its changes are found."""

    def __init__(self) -> None:
        self._known: dict[str, UnitChange] = {}

    def of(self, delta: Delta) -> FieldDelta:
        """Return the delta with the changed fields of its units."""
        return FieldDelta(
            seq=delta.seq,
            after_seq=delta.seq - 1,
            now_ms=delta.now_ms,
            units={unit.unit_id: self._change_of(unit) for unit in delta.units},
            alarms=delta.alarms,
            commands=delta.commands,
            trails=delta.trails,
            **{name: getattr(delta, name) for name in _LATEST},
        )

    def note_snapshot(self, snapshot: Snapshot) -> None:
        """Forget the units that differ in a snapshot: some consoles know them from it, others do
        not, so that the next delta must have them whole.
        """
        now = {unit.unit_id: msgspec.to_builtins(unit) for unit in snapshot.units}
        self._known = {
            unit_id: known for unit_id, known in self._known.items() if now.get(unit_id) == known
        }

    def _change_of(self, unit: UnitView) -> UnitChange:
        now: dict[str, Any] = msgspec.to_builtins(unit)
        before = self._known.get(unit.unit_id)
        self._known[unit.unit_id] = now
        if before is None:
            return now
        change = _difference(before, now)
        if change.get("position"):
            change["position"] |= {name: now["position"][name] for name in _PLACE}
        return change


@lru_cache(_KEPT_MERGED)
def merged_messages(messages: tuple[bytes, ...]) -> bytes:
    """Merge encoded ``FieldDelta`` messages that follow each other into one."""
    return msgspec.json.encode(
        merged([msgspec.json.decode(message, type=FieldDelta) for message in messages])
    )


def merged(several: Sequence[FieldDelta]) -> FieldDelta:
    """Merge changes that follow each other into one."""
    first, last = several[0], several[-1]
    units: dict[str, UnitChange] = {}
    for one in several:
        for unit_id, change in one.units.items():
            units[unit_id] = _both(units.get(unit_id, {}), change)
    return FieldDelta(
        seq=last.seq,
        after_seq=first.after_seq,
        now_ms=last.now_ms,
        units=units,
        alarms=tuple({alarm.alarm_id: alarm for one in several for alarm in one.alarms}.values()),
        commands=tuple(
            {command.command_id: command for one in several for command in one.commands}.values()
        ),
        trails={unit_id: trail for one in several for unit_id, trail in one.trails.items()},
        passed=_passed(several),
        **{name: _latest([getattr(one, name) for one in several]) for name in _LATEST},
    )


def _latest(values: Sequence[Any]) -> Any:
    return next((value for value in reversed(values) if value is not None), None)


def _passed(several: Sequence[FieldDelta]) -> Mapping[str, tuple[TrailPoint, ...]]:
    """Positions of units in all of the messages but the last, whose positions it has itself."""
    passed: dict[str, tuple[TrailPoint, ...]] = {}
    for one in several[:-1]:
        for unit_id, change in one.units.items():
            position: Any = change.get("position")
            if not position:
                continue
            point = TrailPoint(*(position[name] for name in _PLACE))
            before = passed.get(unit_id, ())
            if not before or point.t_ms - before[-1].t_ms >= _POINT_STEP_MS:
                passed[unit_id] = (*before, point)
    return passed


def _difference(before: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, Any]:
    """Fields of ``now`` whose values differ from those before."""
    return {
        name: _difference(before[name], value)
        if isinstance(value, dict) and isinstance(before[name], dict)
        else value
        for name, value in now.items()
        if value != before[name]
    }


def _both(change: Mapping[str, Any], later: Mapping[str, Any]) -> dict[str, Any]:
    """Merge two changes that follow each other."""
    nested = {
        name: _both(change[name], value)
        for name, value in later.items()
        if isinstance(value, dict) and isinstance(change.get(name), dict)
    }
    return {**change, **later, **nested}
