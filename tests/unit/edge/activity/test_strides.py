"""A foot's path cut into strides: begin, duration and length of each."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from edge.activity.strides import Stride, StrideCutter, up_in_body
from edge.tracker.interface import TrackBatch
from edge.tracker.track_rows import empty_rows
from shared.clock import NS_PER_S

Row = tuple[float, float, float, float, bool]  # time, north, east, down, standing


def rows(reported: list[Row]) -> TrackBatch:
    t_s, north_m, east_m, down_m, standing = (
        np.array(column) for column in zip(*reported, strict=True)
    )
    return replace(
        empty_rows(),
        t_ns=np.rint(t_s * NS_PER_S).astype(np.int64),
        position_n_m=np.column_stack((north_m, east_m, down_m)),
        quaternion_nb=np.tile([1.0, 0.0, 0.0, 0.0], (len(reported), 1)),
        stationary=standing.astype(bool),
        steps=np.zeros(len(reported), np.int64),
    )


def part(track: TrackBatch, first: int, stop: int) -> TrackBatch:
    kept = slice(first, stop)
    return replace(
        track,
        t_ns=track.t_ns[kept],
        position_n_m=track.position_n_m[kept],
        quaternion_nb=track.quaternion_nb[kept],
        stationary=track.stationary[kept],
        steps=track.steps[kept],
    )


def walk(strides: int = 5, swing_s: float = 0.6, stance_s: float = 0.4) -> TrackBatch:
    """Each stride 0.9 m north and 1.2 m east, and 0.2 m down; fifty rows a second."""
    reported: list[Row] = []
    period_s = swing_s + stance_s
    for k in range(round(50 * strides * period_s) + 1):
        t_s = k / 50.0
        done, into_s = divmod(t_s + 1e-9, period_s)
        share = done + max(0.0, into_s - stance_s) / swing_s
        reported.append((t_s, 0.9 * share, 1.2 * share, 0.2 * share, into_s < stance_s))
    return rows(reported)


def figures(strides: list[Stride]) -> list[tuple[int, float, float, float]]:
    return [(one.end_ns, one.period_s, one.length_m, one.rise_m) for one in strides]


def test_stride_has_a_length_along_the_ground_and_a_separate_rise() -> None:
    strides = StrideCutter().push(walk())
    assert [stride.end_ns for stride in strides] == [second * NS_PER_S for second in range(1, 6)]
    assert [stride.length_m for stride in strides] == pytest.approx([1.5] * 5)
    assert [stride.rise_m for stride in strides] == pytest.approx([-0.2] * 5)


@pytest.mark.parametrize("at_once", [1, 4, 50])
def test_strides_are_the_same_in_any_batching(at_once: int) -> None:
    track = walk()
    cutter = StrideCutter()
    cut: list[Stride] = []
    for first in range(0, len(track), at_once):
        cut += cutter.push(part(track, first, first + at_once))
        cut += cutter.push(empty_rows())
    assert figures(cut) == figures(StrideCutter().push(track))


def test_stride_lasts_from_footfall_to_footfall() -> None:
    """The first has no footfall before it: its swing is taken for three quarters of it."""
    strides = StrideCutter().push(walk(strides=3))
    assert [stride.period_s for stride in strides] == pytest.approx([0.62 / 0.75, 1.0, 1.0])
    assert strides[0].speed_mps == pytest.approx(1.5 / 0.62 * 0.75)


@pytest.mark.parametrize(("rested_s", "period_s"), [(2.3, 2.9), (2.5, 0.6 / 0.75)])
def test_rest_is_no_part_of_a_stride(rested_s: float, period_s: float) -> None:
    """Three seconds from footfall to footfall at most."""
    again_s = 1.0 + rested_s
    track = rows(
        [
            (0.0, 0.0, 0.0, 0.0, True),
            (0.1, 0.1, 0.0, 0.0, False),
            (1.0, 1.4, 0.0, 0.0, True),
            (again_s, 1.4, 0.0, 0.0, True),
            (again_s + 0.1, 1.5, 0.0, 0.0, False),
            (again_s + 0.6, 2.8, 0.0, 0.0, True),
        ]
    )
    assert StrideCutter().push(track)[1].period_s == pytest.approx(period_s)


@pytest.mark.parametrize(("swing_s", "counts"), [(0.36, True), (0.34, False)])
def test_swing_of_less_than_a_third_of_a_second_is_refused(swing_s: float, counts: bool) -> None:
    track = rows(
        [
            (0.0, 0.0, 0.0, 0.0, True),
            (0.1, 0.1, 0.0, 0.0, False),
            (swing_s, 0.8, 0.0, 0.0, True),
        ]
    )
    assert len(StrideCutter().push(track)) == counts


@pytest.mark.parametrize(
    ("stood_s", "length_m"), [(0.09, 1.6), (0.11, 1.0)], ids=["in the air", "on the ground"]
)
def test_short_stance_after_too_short_a_swing_was_in_the_air(
    stood_s: float, length_m: float
) -> None:
    off_s = 0.3 + stood_s
    track = rows(
        [
            (0.0, 0.0, 0.0, 0.0, True),
            (0.1, 0.3, 0.0, 0.0, False),
            (0.3, 0.6, 0.0, 0.0, True),
            (off_s, 0.6, 0.0, 0.0, True),
            (off_s + 0.02, 0.7, 0.0, 0.0, False),
            (off_s + 0.5, 1.6, 0.0, 0.0, True),
        ]
    )
    (stride,) = StrideCutter().push(track)
    assert stride.length_m == pytest.approx(length_m)


def test_doubted_footfall_does_not_affect_the_next() -> None:
    """The stance after a whole stride may be as short as a runner's."""
    track = rows(
        [
            (0.0, 0.0, 0.0, 0.0, True),
            (0.1, 0.3, 0.0, 0.0, False),
            (0.3, 0.6, 0.0, 0.0, True),  # doubted
            (0.32, 0.7, 0.0, 0.0, False),
            (0.8, 2.0, 0.0, 0.0, True),
            (0.86, 2.0, 0.0, 0.0, True),
            (0.88, 2.1, 0.0, 0.0, False),
            (1.3, 4.0, 0.0, 0.0, True),
        ]
    )
    strides = StrideCutter().push(track)
    assert [stride.length_m for stride in strides] == pytest.approx([2.0, 2.0])


def test_track_that_begins_in_the_air_has_no_stride_before_the_first_stance() -> None:
    track = rows(
        [
            (0.0, 5.0, 0.0, 0.0, False),
            (0.5, 6.0, 0.0, 0.0, True),
            (0.9, 6.0, 0.0, 0.0, True),
            (1.0, 6.2, 0.0, 0.0, False),
            (1.5, 7.5, 0.0, 0.0, True),
        ]
    )
    (stride,) = StrideCutter().push(track)
    assert stride.length_m == pytest.approx(1.5)


def test_place_that_is_no_number_makes_no_stride_and_affects_no_later_one() -> None:
    track = walk(strides=4)
    track.position_n_m[track.t_ns == 2 * NS_PER_S] = np.nan
    strides = StrideCutter().push(track)
    assert [stride.end_ns // NS_PER_S for stride in strides] == [1, 3, 4]
    assert [stride.length_m for stride in strides] == pytest.approx([1.5] * 3)
    assert all(math.isfinite(stride.period_s) for stride in strides)


def test_clock_set_back_makes_no_stride_of_no_time() -> None:
    cutter = StrideCutter()
    cutter.push(walk(strides=3))
    cutter.push(rows([(3.1, 2.7, 3.6, 0.6, False)]))
    strides = cutter.push(walk(strides=3))
    assert len(strides) == 3
    assert all(stride.period_s > 0.5 for stride in strides)


def attitude(roll_rad: float, pitch_rad: float, heading_rad: float) -> np.ndarray:
    """Quaternion (4,) of heading, then pitch, then roll."""

    def turn(axis: int, angle_rad: float) -> np.ndarray:
        out = np.zeros(4)
        out[0], out[1 + axis] = math.cos(angle_rad / 2.0), math.sin(angle_rad / 2.0)
        return out

    def times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        vector = a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
        return np.concatenate(([a[0] * b[0] - a[1:] @ b[1:]], vector))

    return times(times(turn(2, heading_rad), turn(1, pitch_rad)), turn(0, roll_rad))


@pytest.mark.parametrize("heading_rad", [0.0, 2.0])
@pytest.mark.parametrize(
    ("roll_rad", "pitch_rad", "up_b"),
    [
        (0.0, 0.0, (0.0, 0.0, -1.0)),
        (math.pi / 2, 0.0, (0.0, -1.0, 0.0)),  # tipped to the right: the left side is up
        (0.0, math.pi / 2, (1.0, 0.0, 0.0)),  # toes up
        (math.pi / 6, math.pi / 3, (math.sqrt(0.75), -0.25, -math.sqrt(3.0) / 4.0)),
    ],
)
def test_up_direction_of_the_foot_is_independent_of_its_heading(
    roll_rad: float, pitch_rad: float, up_b: tuple[float, float, float], heading_rad: float
) -> None:
    stated = up_in_body(attitude(roll_rad, pitch_rad, heading_rad))
    assert stated == pytest.approx(up_b, abs=1e-12)


def test_stride_has_the_attitude_of_the_footfall() -> None:
    track = walk(strides=1)
    track.quaternion_nb[-1] = attitude(0.0, math.pi / 2, 0.0)
    (stride,) = StrideCutter().push(track)
    assert stride.up_b == pytest.approx((1.0, 0.0, 0.0), abs=1e-12)


def test_footfall_with_an_attitude_that_is_no_number_ends_no_stride() -> None:
    """The standing attitude is learnt from it: one such stride would never be dropped."""
    track = walk(strides=3)
    whole = StrideCutter().push(track)
    track.quaternion_nb[track.t_ns == whole[1].end_ns] = np.nan
    found = StrideCutter().push(track)
    assert [one.end_ns for one in found] == [whole[0].end_ns, whole[2].end_ns]
    assert all(np.isfinite(one.up_b).all() for one in found)
