"""The console has a name for every tracker, and for every place of a sensor."""

from __future__ import annotations

import re
from pathlib import Path

from edge.body_places import PLACES
from edge.tracker.registry import MULTI_SENSOR_TRACKERS, TRACKERS

CATALOGUE = Path(__file__).resolve().parents[2] / ("base_station/console/src/language/en/member.ts")


def keys_of(name: str) -> list[str]:
    text = CATALOGUE.read_text(encoding="utf-8")
    part = re.search(rf"export const {name} = \{{(.*?)\}}", text, re.DOTALL)
    assert part is not None
    return re.findall(r'^  "?([\w-]+)"?: "', part[1], re.MULTILINE)


def test_every_tracker_has_a_name_at_the_console() -> None:
    names = [one.name for one in TRACKERS] + [one.name for one in MULTI_SENSOR_TRACKERS]
    assert sorted(keys_of("tracker")) == sorted(names)


def test_every_place_of_a_sensor_has_a_name_at_the_console() -> None:
    assert sorted(keys_of("worn")) == sorted(PLACES)
