"""Fixtures: trackers and simulated people."""

from __future__ import annotations

import pytest

from base_station.fusion import FUSERS
from base_station.fusion.interface import FuserKind


@pytest.fixture(params=FUSERS[:1], ids=lambda kind: kind.name)
def kind(request: pytest.FixtureRequest) -> FuserKind:
    """The fuser that a station uses; of a baseline is asked what its own tests say."""
    found: FuserKind = request.param
    return found
