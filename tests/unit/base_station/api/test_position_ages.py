"""Ages of positions, counted on their way to consoles."""

from __future__ import annotations

import msgspec

from base_station.api.position_ages import BOUNDS_S, PositionAges
from base_station.views.wire import Delta, UnitView
from tests.e2e.scenes import NOW_MS, unit


def delta(*units: UnitView, now_ms: int = NOW_MS) -> Delta:
    return Delta(1, now_ms, units=units)


def at(t_ms: int, link: str = "live", index: int = 0) -> UnitView:
    shown = unit(index)
    assert shown.position is not None
    position = msgspec.structs.replace(shown.position, t_ms=t_ms)
    return msgspec.structs.replace(shown, position=position, link=link)


def test_each_position_is_counted_once_by_its_age() -> None:
    ages = PositionAges()
    ages.observe(delta(at(NOW_MS - 250), at(NOW_MS - 4_000, index=1)))
    ages.observe(delta(at(NOW_MS - 250), now_ms=NOW_MS + 600))  # only its status is new
    counts = dict(zip((*BOUNDS_S, None), ages.cumulative(), strict=True))
    assert (counts[0.2], counts[0.3], counts[3.0], counts[5.0], counts[None]) == (0, 1, 1, 2, 2)
    assert ages.sum_s == 4.25


def test_position_that_is_not_live_is_not_counted() -> None:
    ages = PositionAges()
    nowhere = msgspec.structs.replace(unit(2), position=None)
    ages.observe(delta(at(NOW_MS - 60_000, link="lost"), nowhere))
    assert ages.cumulative()[-1] == 0


def test_position_ahead_of_the_station_clock_has_no_age() -> None:
    ages = PositionAges()
    ages.observe(delta(at(NOW_MS + 40)))
    assert ages.cumulative()[0] == 1
    assert ages.sum_s == 0.0
