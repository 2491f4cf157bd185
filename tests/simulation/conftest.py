"""Fixtures: trackers and simulated people."""

from __future__ import annotations

import pytest

from base_station.fusion import FUSERS
from base_station.fusion.interface import FuserKind


@pytest.fixture(params=FUSERS, ids=lambda kind: kind.name)
def kind(request: pytest.FixtureRequest) -> FuserKind:
    found: FuserKind = request.param
    return found
