"""The signs of docs/conventions.md, axis by axis, through the strapdown core."""

from __future__ import annotations

import math

import numpy as np
import pytest

from edge.tracker.mechanization.strapdown import GRAVITY_MPS2, advance, rotation_matrix

AT_REST = (0.0, 0.0, -GRAVITY_MPS2)
NO_TURN = (0.0, 0.0, 0.0)


class Walk:
    """A level FRD sensor facing north, moved by constant specific force and rate for 1 s."""

    def __init__(self, accel_b_mps2, gyro_b_radps, heading_rad=0.0):
        self.position_n_m, self.velocity_n_mps = np.zeros(3), np.zeros(3)
        quaternion_nb = np.array([math.cos(heading_rad / 2), 0.0, 0.0, math.sin(heading_rad / 2)])
        self.rotation_nb = np.zeros((3, 3))
        rotation_matrix(quaternion_nb, self.rotation_nb)
        for _ in range(100):
            advance(
                self.position_n_m,
                self.velocity_n_mps,
                quaternion_nb,
                self.rotation_nb,
                np.array(accel_b_mps2),
                np.array(gyro_b_radps),
                GRAVITY_MPS2,
                0.01,
                np.zeros(3),
                np.zeros(3),
            )
        forward, right = self.rotation_nb[:, 0], self.rotation_nb[:, 1]
        self.heading_rad = math.atan2(forward[1], forward[0])
        self.pitch_rad = -math.asin(forward[2])
        self.roll_rad = math.asin(right[2])


def test_at_rest_nothing_moves():
    walk = Walk(AT_REST, NO_TURN)
    np.testing.assert_allclose(walk.position_n_m, 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("heading_rad", "axis"), [(0.0, 0), (math.pi / 2, 1)], ids=["north", "east"]
)
def test_starting_forward(heading_rad, axis):
    walk = Walk((1.0, 0.0, -GRAVITY_MPS2), NO_TURN, heading_rad)
    assert walk.position_n_m[axis] == pytest.approx(0.5)
    assert abs(walk.position_n_m[1 - axis]) < 1e-9


def test_climbing_makes_down_fall():
    assert Walk((0.0, 0.0, -GRAVITY_MPS2 - 1.0), NO_TURN).position_n_m[2] == pytest.approx(-0.5)


def test_turning_right_makes_heading_grow():
    assert Walk(AT_REST, (0.0, 0.0, 0.5)).heading_rad == pytest.approx(0.5)


def test_raising_the_toes_is_positive_pitch():
    assert Walk(AT_REST, (0.0, 0.5, 0.0)).pitch_rad == pytest.approx(0.5)


def test_tipping_to_the_right_is_positive_roll():
    assert Walk(AT_REST, (0.5, 0.0, 0.0)).roll_rad == pytest.approx(0.5)
