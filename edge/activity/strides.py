"""Segmentation of the tracker's rows into strides, from one footfall to the next."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, hypot, pi, remainder

import numpy as np

from edge.samples import Floats
from edge.tracker.interface import TrackBatch
from shared.clock import NS_PER_S

_SHORTEST_SWING_NS = 7 * NS_PER_S // 20  # sprinters need longer
_SHORTEST_STANCE_NS = NS_PER_S // 10  # after a shorter swing: else the foot was still in the air
_SWING_SHARE = 0.75  # of a stride: gives the period of the first one after a rest
_LONGEST_PERIOD_NS = 3 * NS_PER_S  # longer: the foot rested before
_USUAL_PERIOD_NS = 11 * NS_PER_S // 10  # of the first stride of a trunk after a rest


@dataclass(frozen=True, slots=True, eq=False)
class Stride:
    """Stride from lift-off to the next footfall."""

    end_ns: int
    period_s: float  # from the footfall before
    length_m: float  # horizontal
    rise_m: float
    up_b: Floats  # (3,) unit vector away from the ground at the footfall, sensor axes
    step_b: Floats = field(default_factory=lambda: np.zeros(3))  # (3,) m, sensor axes there
    turn_rad: float = 0.0  # of the foot about the vertical, clockwise from above

    @property
    def speed_mps(self) -> float:
        return self.length_m / self.period_s


@dataclass(frozen=True, slots=True, eq=False)
class _Footing:
    t_ns: int
    position_n_m: Floats  # (3,)
    quaternion_nb: Floats  # (4,)


class StrideCutter:
    """Cutter that takes the rows of one tracker in order, however they are batched."""

    def __init__(self) -> None:
        self._standing = False
        self._last: _Footing | None = None  # the row before
        self._lifted: _Footing | None = None  # where the foot left the ground
        self._footfall_ns: int | None = None
        self._unconfirmed_ns: int | None = None  # a footfall after too short a swing
        self._steps = 0  # of the row before
        self._counted: _Footing | None = None  # where a trunk's tracker has counted the last one

    def push(self, track: TrackBatch) -> list[Stride]:
        """Return the strides that end within these rows.

        A foot stands still at the end of each; a trunk does not, and its tracker counts them.
        """
        if not len(track):
            return []
        counted = (np.diff(track.steps, prepend=self._steps) > 0) & ~track.stationary
        self._steps = int(track.steps[-1])
        if self._counted is not None or counted.any():
            return [self._count(track, row) for row in np.flatnonzero(counted).tolist()]
        return self._by_stances(track)

    def _count(self, track: TrackBatch, row: int) -> Stride:
        """Return the stride that a trunk's tracker has counted in this row."""
        here = _footing(track, row)
        begin = self._counted or self._lifted or here
        period_ns = here.t_ns - begin.t_ns
        if not _SHORTEST_SWING_NS <= period_ns <= _LONGEST_PERIOD_NS:
            period_ns = _USUAL_PERIOD_NS
        self._counted = here
        return _stride(begin, here, period_ns)

    def _by_stances(self, track: TrackBatch) -> list[Stride]:
        strides: list[Stride] = []
        changes = np.flatnonzero(np.diff(track.stationary, prepend=self._standing))
        for row in changes.tolist():
            self._standing = bool(track.stationary[row])
            if self._standing:
                strides += self._step_down(track, row)
            else:
                self._lift(_footing(track, row - 1) if row else self._last)
        self._last = _footing(track, len(track) - 1)
        return strides

    def _lift(self, footing: _Footing | None) -> None:
        if footing is None:
            return
        unconfirmed_ns, self._unconfirmed_ns = self._unconfirmed_ns, None
        if unconfirmed_ns is None or footing.t_ns - unconfirmed_ns >= _SHORTEST_STANCE_NS:
            self._lifted = footing

    def _step_down(self, track: TrackBatch, row: int) -> list[Stride]:
        down = _footing(track, row)
        lifted = self._lifted
        if lifted is None or down.t_ns <= lifted.t_ns:
            return []
        swing_ns = down.t_ns - lifted.t_ns
        finite = np.isfinite([*down.position_n_m, *lifted.position_n_m, *down.quaternion_nb]).all()
        if swing_ns < _SHORTEST_SWING_NS or not finite:
            self._unconfirmed_ns = down.t_ns
            return []
        period_ns = down.t_ns - self._footfall_ns if self._footfall_ns is not None else 0
        self._footfall_ns = down.t_ns
        if not swing_ns <= period_ns <= _LONGEST_PERIOD_NS:
            period_ns = round(swing_ns / _SWING_SHARE)
        return [_stride(lifted, down, period_ns)]


def _stride(begin: _Footing, end: _Footing, period_ns: int) -> Stride:
    step_n_m = end.position_n_m - begin.position_n_m
    north_m, east_m, sink_m = step_n_m.tolist()
    return Stride(
        end.t_ns,
        period_ns / NS_PER_S,
        hypot(north_m, east_m),
        -sink_m,
        up_in_body(end.quaternion_nb),
        _in_body(end.quaternion_nb, step_n_m),
        _turn_rad(begin.quaternion_nb, end.quaternion_nb),
    )


def up_in_body(quaternion_nb: Floats) -> Floats:
    """Return the direction up (3,) in sensor axes at an attitude (4,)."""
    w, x, y, z = quaternion_nb.tolist()
    return -np.array([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)])


def _in_body(quaternion_nb: Floats, vector_n: Floats) -> Floats:
    """Return a vector (3,) of the navigation frame in sensor axes at an attitude (4,)."""
    scalar, vector = quaternion_nb[0], -quaternion_nb[1:]
    twice = 2.0 * np.cross(vector, vector_n)
    return np.asarray(vector_n + scalar * twice + np.cross(vector, twice))


def _turn_rad(before_nb: Floats, after_nb: Floats) -> float:
    """Return the turn about the vertical from one attitude (4,) to another, clockwise."""
    w, x, y, z = after_nb
    a, b, c, d = before_nb[0], *(-before_nb[1:])
    scalar = w * a - x * b - y * c - z * d
    down = w * d + x * c - y * b + z * a
    return remainder(2.0 * atan2(down, scalar), 2.0 * pi)


def _footing(track: TrackBatch, row: int) -> _Footing:
    quaternion_nb = track.quaternion_nb[row].copy()
    return _Footing(int(track.t_ns[row]), track.position_n_m[row].copy(), quaternion_nb)
