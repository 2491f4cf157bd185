"""Fusers of units: one a unit, restored where it was saved, deleted with the unit."""

from __future__ import annotations

from base_station.core.positioning.unit_fusers import UnitFusers
from base_station.core.state import UnitState
from base_station.fusion import FUSERS
from base_station.fusion.smoothing import SMOOTHERS
from shared.messages import Header
from tests.rig import message_factory

UNIT = UnitState("FF-01")


def new_fusers(saved: dict[str, bytes] | None = None) -> UnitFusers:
    return UnitFusers(FUSERS[0], SMOOTHERS[0], saved or {}, {})


def test_unit_without_pins_has_one_fuser_and_keeps_it() -> None:
    fusers = new_fusers()
    assert fusers.of(UNIT) == (fusers.plain(UNIT),)
    assert list(fusers.existing([UNIT])) == [fusers.plain(UNIT)]


def test_saved_fuser_is_restored_with_its_estimate() -> None:
    fusers = new_fusers()
    position = message_factory.position(Header(UNIT.unit_id, 7, 1, 1_000_000_000), north_m=3.0)
    fusers.plain(UNIT).predict(position)
    restored = new_fusers(fusers.save())
    assert restored.plain(UNIT).estimate() == fusers.plain(UNIT).estimate() is not None


def test_erased_unit_begins_anew() -> None:
    fusers = new_fusers()
    before = fusers.plain(UNIT)
    assert fusers.forget(UNIT) is before
    assert list(fusers.existing([UNIT])) == []
    assert fusers.plain(UNIT) is not before
