"""Positions with an impossible time or place move nobody, and the unit is followed on."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import pytest

from base_station.fusion.gnss.outliers import Outliers
from base_station.fusion.odometry.odometry_increments import OdometryIncrements
from base_station.fusion.parameters import Parameters
from shared.messages import FusedPosition, Header
from shared.messages.station import SetAnchor
from shared.quality import Quality
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
LAT_DEG, LON_DEG = 52.0, 4.0
NORTH_M_PER_DEG = 111_267.0
WALKS_S, WRONG_AT_S = 90, 60
SPEED_MPS = 1.2
Wrong = Callable[[Script, float], None]


def walk(script: Script, wrong: Wrong) -> Iterator[tuple[float, FusedPosition]]:
    """Straight north with a fix a second; at a minute something ``wrong`` is sent."""
    script.register(U)
    script.act(SetAnchor(LAT_DEG, LON_DEG, 0.0, 0.0))
    for step in range(WALKS_S * 5):
        script.now_s = step / 5
        north_m = SPEED_MPS * script.now_s
        if step == WRONG_AT_S * 5:
            wrong(script, north_m)
        script.position(U, north_m, 0.0, distance_m=north_m)
        if step % 5 == 0:
            lat_deg = LAT_DEG + north_m / NORTH_M_PER_DEG
            script.gps(U, lat_deg, LON_DEG, height_m=0.0, horizontal_std_m=1.5)
        yield north_m, script.fused[-1]


def of_time(ahead_s: float) -> Wrong:
    def say(script: Script, north_m: float) -> None:
        header = script.header(U, script.now_s + ahead_s)
        script.say(message_factory.position(header, north_m=north_m, distance_m=north_m))

    return say


def of_place(aside_m: float) -> Wrong:
    def say(script: Script, north_m: float) -> None:
        script.position(U, north_m - aside_m, aside_m, distance_m=north_m)
        lat_deg = LAT_DEG + north_m / NORTH_M_PER_DEG  # a fix before the path is right again
        script.gps(U, lat_deg, LON_DEG, height_m=0.0, horizontal_std_m=1.5)

    return say


@pytest.mark.slow
@pytest.mark.parametrize(
    "wrong",
    [of_time(86_400.0), of_time(10.0), of_time(-86_400.0), of_place(30.0), of_place(2e6)],
    ids=["a day ahead", "ten seconds ahead", "a day ago", "aside", "far aside"],
)
def test_one_wrong_position_moves_no_member_and_stops_nothing(wrong: Wrong) -> None:
    script = Script()
    for true_north_m, fused in walk(script, wrong):
        if script.now_s > 20.0:
            assert math.hypot(fused.north_m - true_north_m, fused.east_m) < 3.0
    assert fused.quality is Quality.GOOD


def test_uncertainty_grows_no_faster_than_people_run() -> None:
    """A faulty unit claims a perfect place in one message, and none in the next."""
    kind = Parameters()
    own = OdometryIncrements(kind)
    sure = message_factory.position(Header(U, 1, 1, 0), quality=Quality.DEGRADED)
    lost = message_factory.position(
        Header(U, 1, 2, 200_000_000), quality=Quality.DEGRADED, std_north_m=4e6, std_east_m=4e6
    )
    own.increment(sure, 0.0)
    increment = own.increment(lost, 0.2)
    assert 1.0 < math.sqrt(increment.place_var_m2) <= kind.fastest_mps * 0.2


def test_fixes_show_the_shape_of_a_slow_walk_too() -> None:
    outliers, shape = Outliers(), None
    for second in range(60):
        north_m = 0.6 * second
        shape = outliers.add((20.0, north_m), (north_m, 0.0)) or shape
    assert shape is not None
    assert shape.turn_rad == pytest.approx(math.pi / 2.0)
