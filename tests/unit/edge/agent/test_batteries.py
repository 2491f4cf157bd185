"""The battery that represents the unit."""

from __future__ import annotations

from edge.agent.batteries import Batteries
from edge.samples import BatterySample
from shared.clock import NS_PER_S


def test_emptiest_battery_is_that_of_the_unit() -> None:
    batteries = Batteries()
    assert batteries.emptiest(0) is None
    batteries.push(BatterySample(0, 0.8))
    batteries.push(BatterySample(0, 0.3, battery="BAT0"))
    assert batteries.emptiest(NS_PER_S) == BatterySample(0, 0.3, battery="BAT0")


def test_old_reading_counts_only_where_there_is_no_other() -> None:
    batteries = Batteries()
    batteries.push(BatterySample(0, 0.1))
    assert batteries.emptiest(100 * NS_PER_S) == BatterySample(0, 0.1)
    newer = BatterySample(90 * NS_PER_S, 0.9, battery="BAT0")
    batteries.push(newer)
    assert batteries.emptiest(100 * NS_PER_S) == newer
