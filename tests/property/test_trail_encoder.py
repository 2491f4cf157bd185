"""Encoded trails hold the same points as the trails, after any changes."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from base_station.core.state import UnitState
from base_station.core.state.trail import TRAIL_POINTS, TrailStep
from base_station.engine import trail_encoder
from base_station.engine.trail_encoder import BEHIND_NS, TrailEncoder
from shared.clock import NS_PER_S

Change = tuple[str, int]
AT_ONCE = BEHIND_NS // (2 * NS_PER_S)  # points of a trail with one every two seconds
CHANGES = st.lists(
    st.tuples(st.sampled_from(["walk", "leave", "fill", "solve", "clear"]), st.integers(0, 40)),
    max_size=25,
)


def step(t_s: int, north_m: float = 0.0) -> TrailStep:
    return TrailStep(t_s * NS_PER_S + 345_678, north_m, 1.2345, None if t_s % 3 else t_s % 5)


def change(unit: UnitState, what: str, much: int) -> None:
    trail = unit.trails.shown
    end_s = trail[-1].t_ns // NS_PER_S if trail else 0
    if what == "walk":
        trail += [step(end_s + 2 * i + 2, i / 7) for i in range(much)]
    elif what == "leave":
        del trail[:much]
    elif what == "fill" and trail:
        place = much % len(trail)
        trail.insert(place, TrailStep(trail[place].t_ns - NS_PER_S, 3.0, 4.0, 1))
    elif what == "solve":
        unit.trails.shown = [
            msgspec.structs.replace(one, north_m=one.north_m + much) for one in trail
        ]
    elif what == "clear":
        trail.clear()


@given(CHANGES)
def test_encoded_trail_equals_the_trail(changes: list[Change]) -> None:
    unit, trails = UnitState("FF-01"), TrailEncoder()
    for what, much in changes:
        change(unit, what, much)
        if much % 2:
            trails.update_if_behind(unit)
        else:
            reported = msgspec.json.decode(trails.of(unit))
            assert reported == [
                [one.t_ns // 1_000_000, round(one.north_m, 2), round(one.east_m, 2), one.floor]
                for one in unit.trails.shown
            ]


def test_point_is_encoded_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise every console that joins delays all positions."""
    encoded: list[int] = []
    encode = trail_encoder._encoded

    def counted(steps: Sequence[TrailStep]) -> bytes:
        encoded.append(len(steps))
        return encode(steps)

    monkeypatch.setattr(trail_encoder, "_encoded", counted)
    unit, trails = UnitState("FF-01"), TrailEncoder()
    unit.trails.shown = [step(2 * i) for i in range(TRAIL_POINTS)]
    trails.all([unit])
    for i in range(5 * AT_ONCE):
        unit.trails.shown.append(step(2 * (TRAIL_POINTS + i)))
        del unit.trails.shown[0]
        trails.update_if_behind(unit)
    assert encoded == [TRAIL_POINTS, *5 * [AT_ONCE]]
    assert len(msgspec.json.decode(trails.all([unit])["FF-01"])) == TRAIL_POINTS
    assert sum(encoded) == TRAIL_POINTS + 5 * AT_ONCE


def test_unit_without_trail_has_no_encoded_trail() -> None:
    assert TrailEncoder().all([UnitState("FF-01")]) == {}
