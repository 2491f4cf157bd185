"""Motion of a lift's floor: speeding up, going evenly, slowing down."""

from __future__ import annotations

from math import sqrt

import numpy as np

from edge.samples import Floats
from edge.simulation.jet import Jet

ACCEL_MPS2 = 0.9  # at most; comfort allows 1.0 to 1.5
_PEAK = 140.0 / 64.0  # of the rate of the septic from 0 to 1
_OF_NO_WAY_S = 1.0


class LiftMotion:
    """Rests at 0; each ``move`` carries it on.

    The speed rises and falls along the septic 35x^4 - 84x^5 + 70x^6 - 20x^7 (see ``Curve``),
    so that the way has four continuous derivatives.
    """

    def __init__(self) -> None:
        self._moves: list[tuple[float, float, float, float]] = []  # start, rise, even speed, by

    def move(self, start_s: float, by: float, speed_mps: float) -> float:
        """Go ``by`` metres at no more than a speed; return when that ends."""
        if by == 0.0:
            return start_s + _OF_NO_WAY_S
        speed_mps = min(speed_mps, sqrt(abs(by) * ACCEL_MPS2 / _PEAK))
        rise_s = _PEAK * speed_mps / ACCEL_MPS2
        even_s = abs(by) / speed_mps  # from the start of the rise to the start of the fall
        self._moves.append((start_s, rise_s, even_s, by / even_s))
        return start_s + even_s + rise_s

    def jet(self, t_s: Floats) -> Jet:
        """Value and derivatives at times ``t_s`` (n,)."""
        value, rate, accel = np.zeros((3, len(t_s)))
        for start_s, rise_s, even_s, speed in self._moves:
            for side, begin_s in ((1.0, start_s), (-1.0, start_s + even_s)):
                x = np.clip((t_s - begin_s) / rise_s, 0.0, 1.0)
                beyond_s = np.maximum(t_s - begin_s - rise_s, 0.0)
                way = x**5 * (7.0 - x * (14.0 - x * (10.0 - 2.5 * x)))
                value += side * speed * (rise_s * way + beyond_s)
                rate += side * speed * x**4 * (35.0 - x * (84.0 - x * (70.0 - 20.0 * x)))
                accel += side * speed / rise_s * 140.0 * (x * (1.0 - x)) ** 3
        return Jet(value, rate, accel)
