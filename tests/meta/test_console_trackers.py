"""The console has a name for every tracker."""

from __future__ import annotations

import re
from pathlib import Path

from edge.tracker.registry import MULTI_SENSOR_TRACKERS, TRACKERS

CATALOGUE = Path(__file__).resolve().parents[2] / ("base_station/console/src/language/en/member.ts")


def test_every_tracker_has_a_name_at_the_console() -> None:
    text = CATALOGUE.read_text(encoding="utf-8")
    part = re.search(r"export const tracker = \{(.*?)\}", text, re.DOTALL)
    assert part is not None
    named = re.findall(r'^  "?([\w-]+)"?: "', part[1], re.MULTILINE)
    names = [one.name for one in TRACKERS] + [one.name for one in MULTI_SENSOR_TRACKERS]
    assert sorted(named) == sorted(names)
