"""A path that was solved without a heading: each heading leads to another place, and later fixes
tell which one is right.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.horizontal.heading_hypotheses import GnssObservation, HeadingHypotheses
from base_station.fusion.horizontal.state import turn_and_std
from shared.geo import Anchor, rotate
from shared.messages.pins import SetPin, StartTogether
from shared.messages.station import OpenIncident, SetAnchor
from tests.rig.station_script import Script

U = "FF-01"
ANCHOR = Anchor(52.0, 4.0, 0.0)
GROUND_RANGE_M, OWN_M = np.array([5.0, -3.0]), np.array([40.0, 0.0])


class Walk:
    """Twenty metres north from the anchor, and east from there, a metre a second."""

    def __init__(self, turned_rad: float) -> None:
        self.script, self._turned_rad, self._walked_m = Script(), turned_rad, 0
        self.script.register(U)
        self.script.act(OpenIncident("i", "Mill Lane"))
        self.script.act(SetAnchor(ANCHOR.lat_deg, ANCHOR.lon_deg, 0.0, 0.0))

    @property
    def there_m(self) -> tuple[float, float]:
        return float(min(self._walked_m, 20)), float(max(self._walked_m - 20, 0))

    def go(self, metres: int, *, with_fixes: bool = False) -> None:
        for _ in range(metres):
            self.script.now_s += 1.0
            self._walked_m += 1
            own_m = rotate(*self.there_m, self._turned_rad)
            way_m = float(self._walked_m)
            self.script.position(U, *own_m, distance_m=way_m, heading_std_rad=0.02)
            if with_fixes:
                lat_deg, lon_deg, height_m = ANCHOR.to_geodetic(*self.there_m, 0.0)
                self.script.gps(U, lat_deg, lon_deg, height_m=height_m, horizontal_std_m=2.0)
            self.script.tick()

    def set_start(self) -> None:
        self.script.act(StartTogether("s", (U,), 0, 0.0, 0.0, 0.5, None, None, 0.3, ""))

    def state(self, pin_id: str) -> str:
        return self.script.pipeline.state.site.pin_verdicts[pin_id].state

    def off_m(self) -> float:
        shown = self.script.pipeline.state.units[U].place.fused
        assert shown is not None
        return math.dist((shown.north_m, shown.east_m), self.there_m)


def solved(turn_rad: float | None, turn_std_rad: float) -> HeadingHypotheses:
    """A path of 40 m from a known place, as the smoother solves it."""
    if turn_rad is None:  # a plane: neither rotation nor scale is known
        turn, spread = np.zeros(2), 0.5 * np.eye(2)
    else:
        turn = np.array([math.cos(turn_rad), math.sin(turn_rad)])
        across = np.array([-turn[1], turn[0]])
        spread = turn_std_rad**2 * np.outer(across, across) + 1e-4 * np.outer(turn, turn)
    walked = np.zeros((8, 4))  # begin and rotation of the path
    walked[:4, :4] = np.eye(4)
    walked[:2, 2:] = [[OWN_M[0], -OWN_M[1]], [OWN_M[1], OWN_M[0]]]
    known = np.zeros((4, 4))
    known[:2, :2], known[2:, 2:] = 0.25 * np.eye(2), spread
    covariance = walked @ known @ walked.T
    covariance[4:, 4:] = np.eye(4)
    return HeadingHypotheses.from_gaussian(
        walked @ np.concatenate((GROUND_RANGE_M, turn)), covariance
    )


@pytest.mark.parametrize("true_rad", np.linspace(-3.0, 3.0, 7).tolist())
def test_unknown_heading_leads_anywhere_from_the_begin_of_the_path(true_rad: float) -> None:
    hypotheses = solved(None, math.pi)
    there_m = GROUND_RANGE_M + rotate(float(OWN_M[0]), float(OWN_M[1]), true_rad)
    north_m, east_m = there_m.tolist()
    seen = GnssObservation(north_m, east_m, 0.0, 0.0, slow_m=0.0, common_m=0.0, white_m2=1.0)
    assert hypotheses.distance2(seen) < 3.0, "headings are five degrees apart"
    hypotheses.update(seen)
    mean, covariance = hypotheses.moments()
    turn_rad, std_rad = turn_and_std(mean, covariance)
    assert turn_rad == pytest.approx(true_rad, abs=0.06)
    assert std_rad < 0.1
    assert mean[:2] == pytest.approx(there_m, abs=1.0)


def test_heading_known_in_part_stays_so() -> None:
    mean, covariance = solved(0.7, 0.3).moments()
    turn_rad, std_rad = turn_and_std(mean, covariance)
    assert turn_rad == pytest.approx(0.7, abs=0.01)
    assert std_rad == pytest.approx(0.3, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("turned_rad", [-2.0, -0.5, 1.0, 2.5])
def test_start_set_on_the_way_leaves_the_heading_to_the_fixes(turned_rad: float) -> None:
    walk = Walk(turned_rad)
    walk.go(35)
    walk.set_start()
    walk.go(25, with_fixes=True)
    assert walk.state(f"s:{U}") == "used"
    assert walk.off_m() < 3.0


def test_fixes_that_refute_a_pin_count_within_ten_seconds() -> None:
    """It was possible before: the direction of the path was unknown."""
    walk = Walk(1.0)
    walk.set_start()
    walk.go(40)
    pin_m = rotate(*walk.there_m, 1.2)
    walk.script.act(SetPin("wrong", U, walk.script.t_ns, *pin_m, 0.5, None, None, 0.0, ""))
    assert walk.state("wrong") == "used"
    walk.go(13, with_fixes=True)
    assert walk.state("wrong") == "conflict"
    assert walk.off_m() < 3.0
