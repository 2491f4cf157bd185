"""Falls: begin and end of a drop, a blow and the time without walking."""

from __future__ import annotations

import numpy as np
import pytest

from edge.activity.falls import FallDetector
from edge.activity.strides import Stride
from edge.samples import ImuBatch
from shared.clock import NS_PER_S

RATE_HZ = 100
WEIGHT_MPS2 = 9.81


class Wearer:
    """Applies one force after another, each in a batch of its own."""

    def __init__(self) -> None:
        self.falls = FallDetector()
        self.now_s = 10.0

    def feels(self, force_mps2: float, duration_s: float) -> None:
        count = round(duration_s * RATE_HZ)
        t_ns = np.arange(count) * (NS_PER_S // RATE_HZ) + round(self.now_s * NS_PER_S)
        accel_mps2 = np.tile([0.0, 0.0, force_mps2], (count, 1))
        self.falls.push(ImuBatch(t_ns, accel_mps2, np.zeros((count, 3))))
        self.now_s += duration_s

    def drops(self, force_mps2: float = 0.5, duration_s: float = 0.4) -> None:
        self.feels(force_mps2, duration_s)

    def strikes(self, force_mps2: float = 60.0) -> None:
        self.feels(force_mps2, 0.03)

    def walks(self, strides: int) -> None:
        for _ in range(strides):
            self.now_s += 1.0
            end_ns = round(self.now_s * NS_PER_S)
            self.falls.walk(Stride(end_ns, 0.9, 1.3, 0.0, np.array([0.0, 0.0, 1.0])))

    def confirmed(self, motionless_s: float, *, lying: bool = False) -> bool:
        """Fall confirmed by the next half second."""
        return self.falls.confirm(motionless_s, lying=lying)


@pytest.fixture
def wearer() -> Wearer:
    return Wearer()


@pytest.fixture
def fallen(wearer: Wearer) -> Wearer:
    wearer.drops()
    wearer.strikes()
    return wearer


@pytest.mark.parametrize(
    ("force_mps2", "duration_s", "falls"),
    [(3.5, 0.3, True), (4.5, 0.3, False), (0.5, 0.28, True), (0.5, 0.24, False)],
)
def test_drop_is_a_quarter_of_a_second_with_hardly_any_weight(
    wearer: Wearer, force_mps2: float, duration_s: float, falls: bool
) -> None:
    wearer.drops(force_mps2, duration_s)
    assert not wearer.falls.falling, "not before the blow"
    wearer.strikes()
    assert wearer.falls.falling is falls


@pytest.mark.parametrize(
    ("force_mps2", "after_s", "falls"),
    [(35.0, 0.0, True), (25.0, 0.0, False), (60.0, 0.4, True), (60.0, 0.6, False)],
)
def test_blow_is_three_times_the_weight_and_follows_at_once(
    wearer: Wearer, force_mps2: float, after_s: float, falls: bool
) -> None:
    wearer.drops()
    wearer.feels(WEIGHT_MPS2, after_s)
    wearer.strikes(force_mps2)
    assert wearer.falls.falling is falls


@pytest.mark.parametrize("stood_s", [0.02, 0.2])
def test_two_hops_are_no_drop(wearer: Wearer, stood_s: float) -> None:
    """Between them the foot stood, in a batch without other samples."""
    wearer.drops(duration_s=0.2)
    wearer.feels(WEIGHT_MPS2, stood_s)
    wearer.drops(duration_s=0.2)
    wearer.strikes()
    assert not wearer.falls.falling


def test_motion_for_some_seconds_and_then_stillness_is_a_fall(fallen: Wearer) -> None:
    for _ in range(14):
        assert not fallen.confirmed(0.0)
        assert fallen.falls.falling
    assert not fallen.confirmed(1.9)
    assert fallen.confirmed(2.0)


def test_fall_is_confirmed_once(fallen: Wearer) -> None:
    assert fallen.confirmed(2.0)
    assert not fallen.falls.falling
    assert not fallen.confirmed(2.5)


def test_motion_after_eight_seconds_is_no_fall(fallen: Wearer) -> None:
    for _ in range(17):
        assert not fallen.confirmed(0.0)
    assert not fallen.falls.falling
    assert not fallen.confirmed(30.0), "resting, a minute later"


def test_another_blow_restarts_the_seconds(fallen: Wearer) -> None:
    for _ in range(10):
        fallen.confirmed(0.0)
    fallen.drops()
    fallen.strikes()
    for _ in range(15):
        assert not fallen.confirmed(0.0)
    assert fallen.confirmed(2.0)


def test_missing_values_are_neither_drop_nor_blow(wearer: Wearer) -> None:
    wearer.drops()
    wearer.strikes(float("nan"))
    assert not wearer.falls.falling
    wearer.strikes()
    assert wearer.falls.falling, "the drop was no less one"


def test_missing_sample_does_not_split_a_drop_into_two_hops(wearer: Wearer) -> None:
    wearer.drops(duration_s=0.15)
    wearer.feels(float("nan"), 0.02)
    wearer.drops(duration_s=0.15)
    wearer.strikes()
    assert wearer.falls.falling


@pytest.mark.parametrize("batched", [False, True])
def test_missing_samples_are_no_drop(wearer: Wearer, batched: bool) -> None:
    """A foot in mid swing weighs nothing for a moment; then the samples stop for a while."""
    wearer.drops(duration_s=0.02)
    if batched:
        wearer.feels(float("nan"), 0.5)
    else:
        wearer.now_s += 0.5
    wearer.drops(duration_s=0.02)
    wearer.strikes()
    assert not wearer.falls.falling


@pytest.mark.parametrize(("missed_s", "falls"), [(0.08, True), (0.1, False)])
def test_tenth_of_a_second_at_most_may_be_missing_in_a_drop(
    wearer: Wearer, missed_s: float, falls: bool
) -> None:
    wearer.drops(duration_s=0.15)
    wearer.now_s += missed_s
    wearer.drops(duration_s=0.15)
    wearer.strikes()
    assert wearer.falls.falling is falls


def test_half_received_drop_counts_if_that_half_was_long_enough(wearer: Wearer) -> None:
    wearer.drops(duration_s=0.02)
    wearer.now_s += 0.5
    wearer.drops(duration_s=0.3)
    wearer.strikes()
    assert wearer.falls.falling


@pytest.mark.parametrize(("strides", "falls"), [(0, True), (1, True), (2, False)])
def test_walking_after_the_blow_and_standing_is_a_jump(
    fallen: Wearer, strides: int, falls: bool
) -> None:
    fallen.walks(strides)
    assert fallen.falls.falling is falls
    assert fallen.confirmed(2.0) is falls


def test_walking_after_the_blow_and_lying_is_a_fall(fallen: Wearer) -> None:
    fallen.walks(3)
    assert not fallen.confirmed(1.5, lying=True)
    assert fallen.confirmed(2.0, lying=True)


def test_strides_before_the_blow_are_no_walking_after_it(wearer: Wearer) -> None:
    """A tracker reports them up to a second late."""
    ends_s = 9.0, 10.5, 10.9  # the blow is at 10.4 s, and each began before it
    before = [Stride(round(t_s * NS_PER_S), 0.9, 1.3, 0.0, np.zeros(3)) for t_s in ends_s]
    wearer.drops()
    wearer.strikes()
    for stride in before:
        wearer.falls.walk(stride)
    assert wearer.confirmed(2.0)


def test_another_blow_resets_the_walking(fallen: Wearer) -> None:
    fallen.walks(2)
    fallen.drops()
    fallen.strikes()
    assert fallen.falls.falling
    assert fallen.confirmed(2.0)
