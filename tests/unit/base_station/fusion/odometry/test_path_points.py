"""Points and fixes of a path as rows of integers, and back in SI units."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from base_station.fusion.interface import PlaceFix
from base_station.fusion.odometry.points import (
    BREAK,
    DOUBTFUL,
    NO_FLOOR,
    RESTART,
    Point,
    arrays_of,
    fix_row,
    rows_of,
    thinned,
)
from shared.clock import NS_PER_MS, NS_PER_S

POINT = Point(
    t_ns=1_700_000_000 * NS_PER_S + 123_456_789,
    north_m=-12.344,
    east_m=7.126,
    std_m=0.341,
    heading_rad=-1.5,
    moving_ms=2_345,
    shown_north_m=103.014,
    shown_east_m=-55.557,
    shown_std_m=2.001,
    shown_down_m=-6.403,
    shown_down_std_m=0.777,
    floor=-2,
    flags=DOUBTFUL,
)


def test_every_field_is_restored_to_a_centimetre_and_a_millisecond() -> None:
    fix = PlaceFix(0, -3.211, 4.566, 0.0, 2.503, None)
    later = msgspec.structs.replace(POINT, t_ns=POINT.t_ns + NS_PER_S, floor=NO_FLOOR)
    fixes = np.concatenate([fix_row(fix, one.t_ns) for one in (POINT, later)])
    arrays = arrays_of(rows_of([POINT, later]), fixes)
    t_ns = POINT.t_ns // NS_PER_MS * NS_PER_MS
    assert arrays.t_ns.tolist() == arrays.fix_t_ns.tolist() == [t_ns, t_ns + NS_PER_S]
    assert arrays.own_m[0] == pytest.approx((-12.34, 7.13))
    assert arrays.std_m[0] == pytest.approx(0.35), "none is smaller than it is"
    assert arrays.heading_rad[0] == pytest.approx(math.tau - 1.5, abs=5e-4)
    assert arrays.moving_s[0] == pytest.approx(2.345)
    assert arrays.shown_m[0] == pytest.approx((103.01, -55.56))
    assert arrays.shown_std_m[0] == pytest.approx(2.01)
    assert arrays.down_m[0] == pytest.approx(-6.4)
    assert arrays.down_std_m[0] == pytest.approx(0.78)
    assert arrays.floor.tolist() == [-2, NO_FLOOR]
    assert arrays.flags[0] == DOUBTFUL
    assert arrays.fix_m[0] == pytest.approx((-3.21, 4.57))
    assert arrays.fix_std_m[0] == pytest.approx(2.51)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 256])
def test_thinned_path_keeps_its_ends_and_its_moving_time(count: int) -> None:
    rows = rows_of([Point(second * NS_PER_S, moving_ms=second) for second in range(count)])
    left = thinned(rows)
    assert (left["t_ms"][0], left["t_ms"][-1]) == (rows["t_ms"][0], rows["t_ms"][-1])
    assert left["moving_ms"].sum() == rows["moving_ms"].sum()
    assert len(left) <= count // 2 + 1


def test_thinning_keeps_begins_of_frames_and_adds_up_times_and_flags() -> None:
    flags = [0, RESTART, 0, BREAK, 0, DOUBTFUL, BREAK, 0, 0]
    rows = rows_of([Point(second * NS_PER_S, flags=one) for second, one in enumerate(flags)])
    left = thinned(rows)
    assert (left["t_ms"] // 1000).tolist() == [0, 1, 2, 4, 6, 8]
    assert left["flags"].tolist() == [0, RESTART, 0, BREAK, BREAK | DOUBTFUL, 0]


def test_path_is_not_changed_by_being_thinned() -> None:
    rows = rows_of([Point(second * NS_PER_S, moving_ms=second, flags=BREAK) for second in range(9)])
    before = rows.copy()
    thinned(rows)
    assert np.array_equal(rows, before)
