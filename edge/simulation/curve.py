"""Curves that hold still and move smoothly between values."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from edge.samples import Floats
from edge.simulation.jet import Jet


@dataclass(frozen=True, slots=True, eq=False)
class _Pieces:
    """Arrays (n,) of the moves and holds of a curve."""

    knot_s: Floats  # where each begins
    value: Floats  # ... with which value
    step: Floats  # by which it changes
    per_s: Floats  # its duration's inverse
    begins: Floats  # speed at its beginning
    ends: Floats  # ... at its end
    has_speeds: bool


class Curve:
    """Holds a value, moves to the next one in a given time, holds again.

    A move follows the septic 35x^4 - 84x^5 + 70x^6 - 20x^7, which starts and ends
    with zero velocity, acceleration and jerk: the curve has three continuous
    derivatives wherever moves begin, end or meet.  A move may also end at a speed,
    with which the next one begins; the septic that does it is Hermite's.
    """

    def __init__(self, value: float) -> None:
        self._knot_s: list[float] = [0.0]
        self._value: list[float] = [value]
        self._speed: list[float] = [0.0]
        self._pieces: _Pieces | None = None

    @property
    def end_s(self) -> float:
        """End of the last move."""
        return self._knot_s[-1]

    @property
    def last(self) -> float:
        """The value held at the end."""
        return self._value[-1]

    def move(self, start_s: float, end_s: float, value: float, speed: float = 0.0) -> None:
        """Hold until ``start_s``, then reach ``value`` at ``end_s``; moves come in order.

        With a ``speed`` it arrives so fast, and the next move must begin there and then.
        """
        if start_s < self.end_s - 1e-9 or end_s <= start_s:
            raise ValueError(f"no move from {start_s} to {end_s} s after one until {self.end_s} s")
        if start_s > self.end_s + 1e-9:
            if self._speed[-1] != 0.0:
                raise ValueError(f"no hold from {self.end_s} s on at {self._speed[-1]} a second")
            self._knot_s.append(start_s)
            self._value.append(self.last)
            self._speed.append(0.0)
        self._knot_s.append(end_s)
        self._value.append(value)
        self._speed.append(speed)
        self._pieces = None

    def jet(self, t_s: Floats) -> Jet:
        """Value and derivatives at times ``t_s`` of any shape, none of them negative."""
        if self._pieces is None:
            self._pieces = self._make_pieces()
        pieces = self._pieces
        piece = np.searchsorted(pieces.knot_s, t_s, side="right") - 1
        per_s = pieces.per_s[piece]
        step = pieces.step[piece]
        x = np.minimum((t_s - pieces.knot_s[piece]) * per_s, 1.0)
        rest = 1.0 - x
        hump = x * rest
        step_per_s = step * per_s
        squared = x * x
        way = step * squared * squared * (35.0 - x * (84.0 - x * (70.0 - 20.0 * x)))
        from_rest = Jet(
            pieces.value[piece] + way,
            step_per_s * 140.0 * hump * hump * hump,
            step_per_s * per_s * 420.0 * hump * hump * (rest - x),
        )
        if not pieces.has_speeds:
            return from_rest
        begins, ends = pieces.begins[piece], pieces.ends[piece]
        # What ends at a speed is what begins at it, backwards in time.
        return from_rest + _of_speed(begins, per_s, x) - _of_speed(ends, -per_s, rest)

    def smoothed(self, t_s: Floats, span_s: float) -> Jet:
        """The curve's mean over ``span_s`` around ``t_s``, weighted by a raised cosine."""
        offsets = np.arange(-7, 8) / 16.0
        weights = np.cos(np.pi * offsets) ** 2 / 8.0
        # All at once: a block of a simulation is short, and each call costs more than its numbers.
        around = self.jet(np.maximum(t_s + (offsets * span_s)[:, np.newaxis], 0.0))
        value, rate, accel = np.zeros((3, len(t_s)))
        for number, weight in enumerate(weights):
            value += weight * around.value[number]
            rate += weight * around.rate[number]
            accel += weight * around.accel[number]
        return Jet(value, rate, accel)

    def _make_pieces(self) -> _Pieces:
        # One knot more makes the hold after the last move an ordinary piece.
        knot_s = np.array([*self._knot_s, self.end_s + 1.0])
        value = np.array([*self._value, self.last])
        speed = np.array([*self._speed, 0.0])
        return _Pieces(
            knot_s[:-1], value[:-1], np.diff(value), 1.0 / np.diff(knot_s), speed[:-1], speed[1:],
            has_speeds=bool(speed.any()),
        )  # fmt: skip


def _of_speed(speed: Floats, per_s: Floats, x: Floats) -> Jet:
    """Return what the speed at ``x`` = 0 adds to a move; at 1 nothing is left of it."""
    cubed = x * x * x
    return Jet(
        speed / np.abs(per_s) * (x - cubed * x * (20.0 - x * (45.0 - x * (36.0 - 10.0 * x)))),
        speed * np.sign(per_s) * (1.0 - cubed * (80.0 - x * (225.0 - x * (216.0 - 70.0 * x)))),
        speed * np.abs(per_s) * x * x * (-240.0 + x * (900.0 - x * (1080.0 - 420.0 * x))),
    )
