"""Merge of several messages of changed fields: the result gives the same picture."""

from __future__ import annotations

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from base_station.views.changes import UnitChanges, merged
from base_station.views.wire import Delta, FieldDelta, PinView, UnitView
from tests.e2e import scenes
from tests.rig.applied_delta import patched

UNIT = scenes.unit(0)

_HEATS = st.sampled_from([0.0, 0.5])
_POSITIONS = st.none() | st.builds(
    lambda north_m, floor: msgspec.structs.replace(
        scenes.position(0), north_m=north_m, floor=floor
    ),
    st.sampled_from([0.0, 1.0, 2.0]),
    st.none() | st.integers(0, 1),
)
_ALARMS = st.sampled_from([(), ("a",), ("a", "b")])
_SEEN = st.builds(
    lambda heat, position, alarms: msgspec.structs.replace(
        UNIT, heat_used=heat, position=position, alarms=alarms
    ),
    _HEATS,
    _POSITIONS,
    _ALARMS,
)


def reported(*units: UnitView) -> list[FieldDelta]:
    changes = UnitChanges()
    return [changes.of(Delta(seq, seq, units=(unit,))) for seq, unit in enumerate(units, 1)]


@given(st.lists(_SEEN, min_size=2, max_size=6), st.integers(0, 5))
def test_merged_message_changes_a_unit_like_its_parts(seen: list[UnitView], begin: int) -> None:
    messages = reported(*seen)
    begin = min(begin, len(messages) - 1)
    one = merged(messages[begin:])
    before: object = None
    for message in messages[:begin]:
        before = patched(before, message.units[UNIT.unit_id])
    assert patched(before, one.units[UNIT.unit_id]) == msgspec.to_builtins(seen[-1])
    assert (one.after_seq, one.seq) == (begin, len(messages))


def test_complete_values_are_those_of_the_last_message() -> None:
    pins = (scenes.pin("p", 0, "used", 1.0, ""),)
    raised, resolved = (
        msgspec.structs.replace(scenes.alarm(0, "mayday", 1, "", 0), state=state)
        for state in ("raised", "resolved")
    )

    def one(seq: int, pins: tuple[PinView, ...] | None, state: str) -> FieldDelta:
        alarm = raised if state == "raised" else resolved
        return FieldDelta(seq=seq, after_seq=seq - 1, now_ms=seq, pins=pins, alarms=(alarm,))

    last = merged([one(1, pins, "raised"), one(2, (), "raised"), one(3, None, "resolved")])
    assert (last.pins, last.alarms) == ((), (resolved,))
