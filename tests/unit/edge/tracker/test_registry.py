"""Sensors of a person that fit a tracker of several sensors."""

from __future__ import annotations

import pytest

from edge.tracker.interface import MultiSensorTrackerEntry
from edge.tracker.registry import accepts_placement, make_multi_sensor_tracker
from shared.errors import ConfigError


def no_tracker(sensors, dimensions):
    raise AssertionError("nothing is made here")


PAIR = MultiSensorTrackerEntry(
    "pair", "two sensors", no_tracker, (("chest", "waist"), ("waist", "shank"))
)


@pytest.mark.parametrize(
    ("places", "fits"),
    [
        (["chest", "shank"], True),
        (["shank", "chest"], True),
        (["waist", "chest"], True),
        (["chest"], False),
        (["chest", "chest"], False),
        (["chest", "shank", "foot"], False),
        ([], False),
    ],
)
def test_each_place_is_taken_once_and_none_is_left(places, fits):
    assert accepts_placement(PAIR, places) is fits


def test_an_unknown_name_is_refused():
    with pytest.raises(ConfigError, match="no-such-tracker"):
        make_multi_sensor_tracker("no-such-tracker", {})
