"""Segments along walls correct a drifted heading after the incident; without walls nothing
changes.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.interface import PlaceFix, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.interface import SmoothedPath, Smoother, UnitEvidence
from shared.clock import NS_PER_S
from shared.messages import Header
from tests.rig.message_factory import position

DRIFT_RADPS, LASTS_S = 8e-4, 600


@pytest.fixture(params=SMOOTHERS, ids=lambda smoother: smoother.name)
def smoother(request: pytest.FixtureRequest) -> Smoother:
    found: Smoother = request.param
    return found


def smoothed(smoother: Smoother, directions_rad: list[float]) -> SmoothedPath:
    """Legs of 8 m in these directions, one after the other, by a unit whose heading drifts."""
    history, place = PathHistory(), 0j
    history.set_start(Start(0.0, 0.0, 0.0, 0.0, 0.3, 0.03))
    for second in range(LASTS_S):
        direction_rad = directions_rad[second // 8 % len(directions_rad)]
        place += np.exp(1j * (direction_rad - DRIFT_RADPS * second))
        t_ns = second * NS_PER_S
        header = Header("FF-01", 1, second + 1, t_ns)
        history.append(position(header, north_m=place.real, east_m=place.imag), t_ns, jumped=False)
    evidence = UnitEvidence(history.arrays(), history.start.position, history.start.begin_ns)
    return smoother.smooth({"FF-01": evidence}).paths["FF-01"]


def test_right_angles_correct_the_heading(smoother: Smoother) -> None:
    quarter = math.pi / 2.0
    path = smoothed(smoother, [0.3 + turns * quarter for turns in (0, 1, 2, 1, 0, 3, 2, 3)])
    assert path.turn_rad[-1] == pytest.approx(DRIFT_RADPS * LASTS_S, abs=0.12)


@pytest.mark.parametrize("angle_deg", [8.0, 15.0, 22.0])
def test_each_building_has_walls_of_its_own(smoother: Smoother, angle_deg: float) -> None:
    """A path that is right, in one building, outside, and in one that stands at an angle to it."""
    history, place, quarter = PathHistory(), 0j, math.pi / 2.0
    history.set_start(Start(0.0, 0.0, 0.0, 0.0, 0.3, 0.1))
    rounds = [side * quarter for side in range(4) for _ in range(8)] * 8
    ways = [*rounds, *[0.0] * 100, *(math.radians(angle_deg) + one for one in rounds)]
    outside = range(len(rounds), len(rounds) + 100)
    for second, direction_rad in enumerate(ways):
        place += np.exp(1j * direction_rad)
        t_ns = second * NS_PER_S
        header = Header("FF-01", 1, second + 1, t_ns)
        history.append(position(header, north_m=place.real, east_m=place.imag), t_ns, jumped=False)
        if second in outside:
            history.fix(PlaceFix(t_ns, place.real, place.imag, 0.0, 1.5, None), t_ns)
    evidence = UnitEvidence(history.arrays(), history.start.position, history.start.begin_ns)
    path = smoother.smooth({"FF-01": evidence}).paths["FF-01"]
    assert np.ptp(path.turn_rad) < math.radians(1.0)


def test_arbitrary_directions_change_nothing(smoother: Smoother) -> None:
    rng = np.random.default_rng(4)
    path = smoothed(smoother, rng.uniform(-math.pi, math.pi, 75).tolist())
    assert abs(path.turn_rad[-1]) < 0.1
