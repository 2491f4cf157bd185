"""Recognition of the part of the body that wears a sensor, by the first seconds of walking.

A foot swings faster than any other part, and turns slowly while it stands.  A shank or thigh is
a pendulum over the foot that stands, which turns at walking speed over leg length: it has no slow
part.  Trunk and what is held before it turn slowly throughout and bounce with each step.
"""

from __future__ import annotations

import numpy as np

from edge.body_places import FOOT, LEG, UPPER_BODY
from edge.samples import Floats, ImuBatch
from shared.clock import NS_PER_S

CELL_NS = NS_PER_S // 2
WINDOW_CELLS = 5  # two strides of a slow walk
_LONGEST_NS = 20 * NS_PER_S  # from the first motion to a decision
_VOTES = {FOOT: 2, LEG: 3, UPPER_BODY: 3}  # by which it has to lead; a boot is carried, too
_ENOUGH_SAMPLES = 50
_STIRRING_MPS2, _STIRRING_RADPS = 0.4, 0.5  # spread of force, 95th percentile of rate, of a cell
_MOTION_MPS2 = 1.0  # spread of the specific force's magnitude within a window
_SWING_RADPS = 5.0  # 95th percentile of a window; thighs reach 4 in a walk, feet pass 6
_QUIET_RADPS = 2.5  # 95th percentile; of a trunk in a turn
_PENDULUM_RADPS = 0.8  # 10th percentile; 1.2 m/s over 0.9 m is 1.3, and a swing turns back twice
_STEP_S = (0.3, 1.3)  # between steps, of a run and of two slow steps
_BOUNCE = 0.4  # autocorrelation of the force's magnitude a step later


class MountRecogniser:
    """Recogniser of one sensor; the same however the samples are batched."""

    def __init__(self) -> None:
        self._cell: int | None = None
        self._parts: list[Floats] = []  # (m, 3) time in s, |force|, |rate| of the open cell
        self._cells: list[Floats] = []  # closed ones of the open window
        self._votes = dict.fromkeys(_VOTES, 0)
        self.moved_ns: int | None = None  # the begin of the first motion
        self.still_until_ns: int | None = None  # the end of the last cell before any motion
        self.place: str | None = None  # where it is worn; empty: not recognised; None: not yet

    def push(self, imu: ImuBatch) -> None:
        """Take samples in order."""
        if self.place is not None or not len(imu):
            return
        cells = imu.t_ns // CELL_NS
        rows = np.column_stack(
            (
                imu.t_ns / NS_PER_S,
                np.linalg.norm(imu.accel_mps2, axis=1),
                np.linalg.norm(imu.gyro_radps, axis=1),
            )
        )
        for part in np.split(np.arange(len(imu)), np.flatnonzero(np.diff(cells)) + 1):
            cell = int(cells[part[0]])
            if self._cell is not None and cell != self._cell:
                self._close_cell(self._cell)
            self._cell = cell
            self._parts.append(rows[part])

    def _close_cell(self, cell: int) -> None:
        rows = np.vstack(self._parts)
        self._parts = []
        rows = rows[np.isfinite(rows).all(axis=1)]
        if self.moved_ns is None:
            if not _stirs(rows):
                self.still_until_ns = (cell + 1) * CELL_NS
                return
            self.moved_ns = cell * CELL_NS
        self._cells.append(rows)
        if len(self._cells) == WINDOW_CELLS and self.place is None:
            window = np.vstack(self._cells)
            self._cells = []
            self._take_window(window)
            self._decide_late((cell + 1) * CELL_NS)

    def _take_window(self, rows: Floats) -> None:
        if len(rows) < _ENOUGH_SAMPLES or rows[:, 1].std() < _MOTION_MPS2:
            return
        shown = _place_shown(rows)
        if shown is not None:
            self._votes[shown] += 1
            others = max(votes for place, votes in self._votes.items() if place != shown)
            if self._votes[shown] - others >= _VOTES[shown]:
                self.place = shown

    def _decide_late(self, end_ns: int) -> None:
        """After a while decide by what there is, as the wearer is not located before; go on where
        nothing has walked yet.
        """
        if self.place is not None or self.moved_ns is None:
            return
        if end_ns - self.moved_ns < _LONGEST_NS:
            return
        if not any(self._votes.values()):
            self.moved_ns, self.still_until_ns = None, end_ns
            return
        most = max(self._votes.values())
        leading = [
            place
            for place, votes in self._votes.items()
            if votes == most and votes >= _VOTES[place]
        ]
        self.place = leading[0] if len(leading) == 1 else ""


def _stirs(rows: Floats) -> bool:
    if len(rows) < 2:
        return False
    rate_radps = float(np.percentile(rows[:, 2], 95.0))
    return float(rows[:, 1].std()) > _STIRRING_MPS2 or rate_radps > _STIRRING_RADPS


def _place_shown(rows: Floats) -> str | None:
    """Return the place that a window (n, 3) of motion shows; None: it may be any."""
    slow_radps, fast_radps = np.percentile(rows[:, 2], (10.0, 95.0))
    if fast_radps < _QUIET_RADPS:
        return UPPER_BODY if _bounces(rows[:, 0], rows[:, 1]) else None
    if slow_radps >= _PENDULUM_RADPS:
        return LEG
    return FOOT if fast_radps >= _SWING_RADPS else None


def _bounces(t_s: Floats, force_mps2: Floats) -> bool:
    """Return True where the force (n,) repeats itself after the time of a step."""
    force = force_mps2 - force_mps2.mean()
    period_s = float(t_s[-1] - t_s[0]) / (len(t_s) - 1)
    first, last = (round(lag_s / period_s) for lag_s in _STEP_S)
    power = float(np.mean(force**2))
    lags = range(first, min(last, len(force) - 1) + 1)
    agreement = [float(np.mean(force[:-lag] * force[lag:])) for lag in lags]
    return max(agreement, default=0.0) >= _BOUNCE * power
