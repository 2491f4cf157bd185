"""Dead reckoning of a unit's own path from the place that was known last.

With ``d`` the own path since that place (own frame), ``a`` the turn of the own frame and ``R(a)``
its rotation, the place is ``p = p0 + R(a) d``.  Errors, to first order in the plane:

    place        covariance of p0, and a random walk by distance
    scale        s R(a) d
    turn         e J R(a) d, with e as the turn was known, exact for any size
    its drift    w J R(a) (t0 d + sum t_i d_i), with t_i the time walked from p0 to increment i and
                 t0 that from when the turn was known to p0

``J`` turns by a right angle, ``w`` is the rate by which the own heading drifts while moving.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.kernels import HorizontalEstimate, OdometryIncrement

Floats = NDArray[np.float64]


class DeadReckoning(msgspec.Struct):
    """Place in the incident frame, turn of the own frame, and the path since each was known."""

    scale_std: float
    place_m: tuple[float, float] = (0.0, 0.0)  # north and east
    place_var_m2: tuple[float, float, float] = (0.0, 0.0, 0.0)  # north, east, and between them
    own_m: tuple[float, float] = (0.0, 0.0)  # that place in the own frame
    turn_rad: float = 0.0  # heading of the own north
    turn_known_std_rad: float = math.pi  # at the known place; pi: unknown
    turn_added_var: float = 0.0  # since then, beside the drift
    turn_moving_s: float = 0.0  # walked since then
    drift_radps: float = 0.0  # standard deviation of the drift rate
    moving_s: float = 0.0  # walked since the place was known
    walked_var_m2: float = 0.0  # the random walk since then, each axis
    drifted_ms: tuple[float, float] = (0.0, 0.0)  # sum of t_i d_i

    @property
    def turn_std_rad(self) -> float:
        """Standard deviation of the turn now; pi: not known."""
        drifted_rad = self.drift_radps * self.turn_moving_s
        var = self.turn_known_std_rad**2 + self.turn_added_var + drifted_rad**2
        return min(math.sqrt(var), math.pi)

    def predict(self, increment: OdometryIncrement) -> None:
        """The own path went on."""
        middle_s = self.moving_s + 0.5 * increment.moving_s
        self.drifted_ms = (
            self.drifted_ms[0] + middle_s * increment.north_m,
            self.drifted_ms[1] + middle_s * increment.east_m,
        )
        self.moving_s += increment.moving_s
        self.turn_moving_s += increment.moving_s
        self.walked_var_m2 += increment.place_var_m2
        self.turn_added_var += increment.turn_var
        self.drift_radps = increment.drift_radps

    def set_place(
        self,
        place_m: tuple[float, float],
        place_var_m2: tuple[float, float, float],
        own_m: tuple[float, float],
    ) -> None:
        """The place is known, where the own path was at ``own_m``."""
        self.place_m, self.place_var_m2, self.own_m = place_m, place_var_m2, own_m
        self.moving_s = self.walked_var_m2 = 0.0
        self.drifted_ms = (0.0, 0.0)

    def set_turn(self, turn_rad: float, std_rad: float) -> None:
        """The heading of the own north is known."""
        self.turn_rad, self.turn_known_std_rad = turn_rad, min(std_rad, math.pi)
        self.turn_added_var = self.turn_moving_s = 0.0

    def reframe(self, turn_rad: float, north_m: float, east_m: float) -> None:
        """The incident frame was moved: everything turned clockwise, then shifted."""
        rotation = _rotation(turn_rad)
        shifted_m = rotation @ np.array(self.place_m) + (north_m, east_m)
        turned = rotation @ _matrix(self.place_var_m2) @ rotation.T
        self.place_m = float(shifted_m[0]), float(shifted_m[1])
        self.place_var_m2 = float(turned[0, 0]), float(turned[1, 1]), float(turned[0, 1])
        self.turn_rad += turn_rad

    def estimate_at(
        self, own_m: tuple[float, float], back_m: tuple[float, float] = (0.0, 0.0)
    ) -> HorizontalEstimate:
        """Place and turn where the own path is at ``own_m``; ``back_m``: that much before its end,
        where the wearer was earlier.
        """
        rotation, turn_std_rad = _rotation(self.turn_rad), self.turn_std_rad
        moved_m = rotation @ np.subtract(own_m, self.own_m)
        before_s = self.turn_moving_s - self.moving_s
        end_m = np.add(np.subtract(own_m, self.own_m), back_m)
        middle_s = 0.5 * self.moving_s
        drifted_ms = before_s * end_m + np.array(self.drifted_ms)
        drifted_ms = rotation @ (drifted_ms - (before_s + middle_s) * np.array(back_m))
        along, across = _turn_parts(self.turn_known_std_rad**2 + self.turn_added_var)
        sideways_m, sideways_ms = _right_angle(moved_m), _right_angle(drifted_ms)
        covariance = (
            _matrix(self.place_var_m2)
            + self.walked_var_m2 * np.eye(2)
            + (self.scale_std**2 + along) * np.outer(moved_m, moved_m)
            + across * np.outer(sideways_m, sideways_m)
            + self.drift_radps**2 * np.outer(sideways_ms, sideways_ms)
        )
        std_north_m, std_east_m = np.sqrt(np.diag(covariance)).tolist()
        product = std_north_m * std_east_m
        return HorizontalEstimate(
            north_m=self.place_m[0] + float(moved_m[0]),
            east_m=self.place_m[1] + float(moved_m[1]),
            std_north_m=std_north_m,
            std_east_m=std_east_m,
            correlation_ne=float(covariance[0, 1]) / product if product > 0.0 else 0.0,
            turn_rad=self.turn_rad,
            turn_std_rad=turn_std_rad,
        )


def _turn_parts(var: float) -> tuple[float, float]:
    """Mean squares of ``cos e - 1`` and of ``sin e`` for a Gaussian ``e`` of that variance."""
    var = min(var, math.pi**2)
    twice = math.exp(-2.0 * var)
    along = 0.5 * (1.0 + twice) - 2.0 * math.exp(-0.5 * var) + 1.0
    return max(along, 0.0), 0.5 * (1.0 - twice)


def _rotation(angle_rad: float) -> Floats:
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[cosine, -sine], [sine, cosine]])


def _right_angle(vector: Floats) -> Floats:
    return np.array([-vector[1], vector[0]])


def _matrix(var_m2: tuple[float, float, float]) -> Floats:
    north, east, between = var_m2
    return np.array([[north, between], [between, east]])
