"""Sightings that are published, one a second for each beacon."""

from __future__ import annotations

import math

from edge.agent.sighting_limit import SightingLimit
from edge.samples import BEACON, TAG, SightingSample
from shared.clock import NS_PER_S


def sighting(t_s: float, seen_id: str = "door", kind: str = BEACON) -> SightingSample:
    return SightingSample(round(t_s * NS_PER_S), kind, seen_id, 2.0, math.nan)


def test_the_same_beacon_is_published_once_a_second() -> None:
    limit = SightingLimit()
    assert [limit.takes(sighting(t_s)) for t_s in (5.0, 5.9, 6.0)] == [True, False, True]


def test_other_things_have_a_limit_of_their_own() -> None:
    limit = SightingLimit()
    things = [("door", BEACON), ("stairs", BEACON), ("door", TAG)]
    assert all(limit.takes(sighting(5.0, *thing)) for thing in things)


def test_a_clock_that_was_set_back_stops_no_sighting() -> None:
    limit = SightingLimit()
    limit.takes(sighting(100.0))
    assert limit.takes(sighting(5.0))


def test_at_most_a_thousand_things_are_kept() -> None:
    """Telephones change their addresses every few minutes, all day."""
    limit = SightingLimit()
    assert all(limit.takes(sighting(5.0, f"b{number}")) for number in range(3500))
    assert len(limit._last_ns) <= 1000
