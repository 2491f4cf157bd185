"""Announcements of this station that are kept instead of sent."""

from __future__ import annotations

import pytest

from base_station.app import service_announcement
from tests.rig.announced import Announced


@pytest.fixture
def announced(monkeypatch: pytest.MonkeyPatch) -> Announced:
    announced = Announced()
    monkeypatch.setattr(service_announcement, "Announcer", announced.begin)
    return announced
