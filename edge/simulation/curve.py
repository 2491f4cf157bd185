"""Curves that hold still and move smoothly between values."""

from __future__ import annotations

import numpy as np

from edge.samples import Floats
from edge.simulation.jet import Jet


class Curve:
    """Holds a value, moves to the next one in a given time, holds again.

    A move follows the septic 35x^4 - 84x^5 + 70x^6 - 20x^7, which starts and ends
    with zero velocity, acceleration and jerk: the curve has three continuous
    derivatives wherever moves begin, end or meet.
    """

    def __init__(self, value: float) -> None:
        self._knot_s: list[float] = [0.0]
        self._value: list[float] = [value]
        self._pieces: tuple[Floats, Floats, Floats, Floats] | None = None

    @property
    def end_s(self) -> float:
        """End of the last move."""
        return self._knot_s[-1]

    @property
    def last(self) -> float:
        """The value held at the end."""
        return self._value[-1]

    def move(self, start_s: float, end_s: float, value: float) -> None:
        """Hold until ``start_s``, then reach ``value`` at ``end_s``; moves come in order."""
        if start_s < self.end_s - 1e-9 or end_s <= start_s:
            raise ValueError(f"no move from {start_s} to {end_s} s after one until {self.end_s} s")
        if start_s > self.end_s + 1e-9:
            self._knot_s.append(start_s)
            self._value.append(self.last)
        self._knot_s.append(end_s)
        self._value.append(value)
        self._pieces = None

    def jet(self, t_s: Floats) -> Jet:
        """Value and derivatives at times ``t_s`` (n,), none of them negative."""
        if self._pieces is None:
            self._pieces = self._make_pieces()
        knot_s, value, step, per_s = self._pieces
        piece = np.searchsorted(knot_s, t_s, side="right") - 1
        speed = per_s[piece]
        step = step[piece]
        x = np.minimum((t_s - knot_s[piece]) * speed, 1.0)
        rest = 1.0 - x
        hump = x * rest
        step_speed = step * speed
        squared = x * x
        return Jet(
            value[piece] + step * squared * squared * (35.0 - x * (84.0 - x * (70.0 - 20.0 * x))),
            step_speed * 140.0 * hump * hump * hump,
            step_speed * speed * 420.0 * hump * hump * (rest - x),
        )

    def smoothed(self, t_s: Floats, span_s: float) -> Jet:
        """The curve's mean over ``span_s`` around ``t_s``, weighted by a raised cosine."""
        offsets = np.arange(-7, 8) / 16.0
        weights = np.cos(np.pi * offsets) ** 2 / 8.0
        value, rate, accel = np.zeros((3, len(t_s)))
        for offset, weight in zip(offsets * span_s, weights, strict=True):
            jet = self.jet(np.maximum(t_s + offset, 0.0))
            value += weight * jet.value
            rate += weight * jet.rate
            accel += weight * jet.accel
        return Jet(value, rate, accel)

    def _make_pieces(self) -> tuple[Floats, Floats, Floats, Floats]:
        # One knot more makes the hold after the last move an ordinary piece.
        knot_s = np.array([*self._knot_s, self.end_s + 1.0])
        value = np.array([*self._value, self.last])
        return knot_s[:-1], value[:-1], np.diff(value), 1.0 / np.diff(knot_s)
