"""Rejected fixes of a window: their shape may still be that of the walk."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.fusion.gnss.outliers import MAX_FIXES, MIN_FIXES, SPREAD_M, Outliers, WalkShape
from edge.samples import Floats


def shape_of(seen_m: Floats, own_m: Floats) -> WalkShape | None:
    """Shape of rows north and east; the first that is found."""
    outliers = Outliers()
    shapes = (
        outliers.add((seen[0], seen[1]), (own[0], own[1]))
        for seen, own in zip(seen_m.tolist(), own_m.tolist(), strict=True)
    )
    return next((shape for shape in shapes if shape is not None), None)


def bent(count: int, step_m: float = 1.2) -> Floats:
    """A walk round a corner."""
    way_m = step_m * np.arange(count)
    corner_m = 0.4 * way_m[-1]
    return np.column_stack((np.minimum(way_m, corner_m), np.maximum(way_m - corner_m, 0.0)))


def turned(own_m: Floats, turn_rad: float, scale: float = 1.0) -> Floats:
    """Rotated clockwise, seen from above, and shifted."""
    cosine, sine = scale * math.cos(turn_rad), scale * math.sin(turn_rad)
    elsewhere: Floats = own_m @ np.array([[cosine, sine], [-sine, cosine]]) + [300.0, -80.0]
    return elsewhere


@pytest.mark.parametrize("turn_rad", [-2.5, 0.0, 1.0])
def test_shifted_and_rotated_walk_matches(turn_rad: float) -> None:
    own_m = bent(40)
    noise = np.random.default_rng(1).normal(0.0, 1.5, own_m.shape)
    shape = shape_of(turned(own_m, turn_rad) + noise, own_m)
    assert shape is not None
    assert shape.turn_rad == pytest.approx(turn_rad, abs=0.15)
    assert shape.spread_m >= SPREAD_M * math.sqrt(MIN_FIXES)


def test_outlier_shape_rejects_mirrored_walk() -> None:
    own_m = bent(40)
    assert shape_of(turned(own_m, 0.3) * [1.0, -1.0], own_m) is None


@pytest.mark.parametrize(
    ("scale", "is_walk"), [(0.6, False), (0.85, True), (1.2, True), (1.5, False)]
)
def test_outlier_shape_rejects_scaled_walk(scale: float, is_walk: bool) -> None:
    own_m = bent(40)
    assert (shape_of(turned(own_m, 0.3, scale), own_m) is not None) is is_walk


def test_outlier_shape_rejects_receiver_at_rest() -> None:
    own_m = bent(MAX_FIXES)
    for seed in range(10):
        noise = np.random.default_rng(seed).normal(0.0, 4.0, own_m.shape)
        assert shape_of(noise, own_m) is None


def test_twenty_fixes_suffice_and_fewer_do_not() -> None:
    own_m = bent(MIN_FIXES, step_m=2.0)
    assert shape_of(turned(own_m, 0.3)[:-1], own_m[:-1]) is None
    assert shape_of(turned(own_m, 0.3), own_m) is not None


def test_outlier_shape_needs_a_walk_of_some_extent() -> None:
    """Root mean square 5 m about the middle."""
    own_m = 0.5 * SPREAD_M * np.column_stack((np.cos(np.arange(60)), np.sin(np.arange(60))))
    assert shape_of(turned(own_m, 0.3), own_m) is None
    assert shape_of(turned(2.2 * own_m, 0.3), 2.2 * own_m) is not None


@pytest.mark.parametrize(("unlike", "is_walk"), [(0.2, True), (0.3, False)])
def test_quarter_of_the_scatter_may_be_off_the_walk(unlike: float, is_walk: bool) -> None:
    """The rest of the scatter lies across a straight way, there and back."""
    north_m = 2.0 * np.arange(MIN_FIXES)
    across_m = north_m.std() * math.sqrt(unlike / (1.0 - unlike)) * (-1.0) ** np.arange(MIN_FIXES)
    own_m = np.column_stack((north_m, np.zeros(MIN_FIXES)))
    assert (shape_of(np.column_stack((north_m, across_m)), own_m) is not None) is is_walk


def test_cleared_window_has_no_shape() -> None:
    outliers, own_m = Outliers(), bent(MIN_FIXES, step_m=2.0).tolist()
    for place_m in own_m[:-1]:
        outliers.add(tuple(place_m), tuple(place_m))
    outliers.clear()
    assert outliers.add(tuple(own_m[-1]), tuple(own_m[-1])) is None


def test_fixes_older_than_a_minute_are_dropped() -> None:
    """First the receiver rests, then it moves along."""
    outliers, shape = Outliers(), None
    own_m = bent(5 * MAX_FIXES)
    for row, (north_m, east_m) in enumerate(own_m.tolist()):
        seen_m = (north_m, east_m) if row > 3 * MAX_FIXES else (0.01 * (row % 2), 0.0)
        shape = outliers.add(seen_m, (north_m, east_m))
        assert len(outliers.kept) <= MAX_FIXES
    assert shape is not None
    assert shape.turn_rad == pytest.approx(0.0, abs=1e-9)
