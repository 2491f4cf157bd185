"""Process noise that a unit states of its path, in fusers and smoothers."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from base_station.fusion import FUSERS
from base_station.fusion.interface import Estimate, Fuser, FuserKind, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.parameters import Parameters
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.chain import WalkNoise
from base_station.fusion.smoothing.interface import SmoothedPath, UnitEvidence
from base_station.fusion.stated_noise import (
    MOST_SCALE_STD,
    MOST_TURN_RAD_PER_SQRT_M,
    MOST_WALK_M_PER_SQRT_M,
    with_path_noise,
)
from shared.clock import NS_PER_S
from shared.messages import Header, Position
from shared.path_noise import PathNoise
from tests.rig.message_factory import position

START = Start(0.0, 0.0, 0.0, 0.0, 0.5, 0.02)
WAY_M = 50
USUAL = Parameters()
# The station's own values, which are a foot's.
FOOT = PathNoise(USUAL.scale_std, USUAL.walk_m_per_sqrt_m, USUAL.turn_rad_per_sqrt_m)
TRUNK = PathNoise(0.08, 0.28, 0.014)

by_kind = pytest.mark.parametrize("kind", FUSERS, ids=lambda kind: kind.name)


def north(noise: PathNoise | None, count: int = WAY_M + 1, boot_id: int = 1) -> list[Position]:
    """Positions of a unit that walks north, a metre a second."""
    return [
        position(
            Header("a", boot_id, row + 1, row * NS_PER_S),
            north_m=float(row),
            distance_m=float(row),
            path_noise=noise,
        )
        for row in range(count)
    ]


def walked(fuser: Fuser, positions: list[Position]) -> Estimate:
    for one in positions:
        assert fuser.predict(one) == ""
    estimate = fuser.estimate()
    assert estimate is not None
    return estimate


def begun(kind: FuserKind) -> Fuser:
    fuser = kind.new()
    fuser.start(START)
    return fuser


@pytest.mark.parametrize("parameters", [Parameters(), WalkNoise(), *FUSERS])
def test_what_is_not_stated_stays(parameters):
    assert with_path_noise(parameters, None) is parameters
    one = with_path_noise(parameters, PathNoise(scale_std=0.08))
    assert one.scale_std == 0.08
    assert type(one) is type(parameters)
    assert one.walk_m_per_sqrt_m == parameters.walk_m_per_sqrt_m
    assert one.turn_rad_per_sqrt_m == parameters.turn_rad_per_sqrt_m


def test_rubbish_is_bounded() -> None:
    one = with_path_noise(USUAL, PathNoise(1e6, 1e6, 1e6))
    assert (one.scale_std, one.walk_m_per_sqrt_m, one.turn_rad_per_sqrt_m) == (
        MOST_SCALE_STD,
        MOST_WALK_M_PER_SQRT_M,
        MOST_TURN_RAD_PER_SQRT_M,
    )


@by_kind
def test_foot_noise_changes_no_bit(kind: FuserKind) -> None:
    """Logs of units that state none are replayed as before."""
    assert walked(begun(kind), north(FOOT)) == walked(begun(kind), north(None))


@by_kind
def test_stated_noise_is_that_of_the_estimate(kind: FuserKind) -> None:
    estimate = walked(begun(kind), north(TRUNK))
    assert TRUNK.scale_std
    assert TRUNK.place_std_m_per_sqrt_m
    random_m2 = TRUNK.place_std_m_per_sqrt_m**2 * WAY_M
    along_m = math.sqrt(START.std_m**2 + random_m2 + (TRUNK.scale_std * WAY_M) ** 2)
    assert estimate.std_north_m == pytest.approx(along_m, rel=0.03)
    assert estimate.std_east_m > math.sqrt(random_m2)
    assert estimate.north_m == pytest.approx(WAY_M, abs=0.1)


@by_kind
def test_noise_that_is_stated_before_the_start_is_used_as_well(kind: FuserKind) -> None:
    early, late = begun(kind), kind.new()
    first, *others = north(TRUNK)
    late.predict(first)
    late.start(START)
    one, other = walked(early, [first, *others]), walked(late, others)
    assert one.std_north_m == pytest.approx(other.std_north_m, rel=0.02)


@by_kind
def test_saved_fuser_goes_on_with_the_stated_noise(kind: FuserKind) -> None:
    fuser = begun(kind)
    positions = north(TRUNK)
    walked(fuser, positions[:20])
    restored = kind.restore(fuser.save())
    assert walked(restored, positions[20:]) == walked(fuser, positions[20:])


@by_kind
def test_next_run_of_another_tracker_has_noise_of_its_own(kind: FuserKind) -> None:
    first, *others = north(None, boot_id=2)
    ends = []
    for before in (TRUNK, None):
        fuser = begun(kind)
        walked(fuser, north(before))
        fuser.predict(first)
        fuser.start(START)
        ends.append(walked(fuser, others).std_north_m)
    assert ends[0] == ends[1]


def smoothed(noise: PathNoise | None) -> SmoothedPath:
    history = PathHistory()
    history.set_start(START)
    for one in north(noise):
        history.append(one, one.header.t_mono_ns, jumped=False)
    evidence = UnitEvidence(history.arrays(), START, path_noise=history.path_noise)
    return SMOOTHERS[0].solve({"a": evidence}).paths["a"]


def test_smoother_uses_the_stated_noise() -> None:
    foot, none, trunk = smoothed(FOOT), smoothed(None), smoothed(TRUNK)
    assert np.array_equal(foot.std_north_m, none.std_north_m)
    assert np.array_equal(foot.places_m, none.places_m)
    assert TRUNK.scale_std is not None
    assert trunk.std_north_m[-1] == pytest.approx(math.hypot(TRUNK.scale_std * WAY_M, 2.0), rel=0.1)
    assert none.std_north_m[-1] < 0.4 * trunk.std_north_m[-1]


def test_history_of_older_checkpoints_states_none() -> None:
    fields = msgspec.to_builtins(PathHistory())
    del fields["path_noise"]
    assert msgspec.convert(fields, PathHistory).path_noise is None
