"""Detector of rests, and the mean readings in them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from edge.samples import Floats, ImuBatch
from shared.clock import NS_PER_S

WINDOW_NS = NS_PER_S // 2
_ENOUGH_SAMPLES = 5

# Spread within a window, root of the summed variances: the noise of poor sensors, but no hand.
_STILL_ACCEL_MPS2 = 0.2
_STILL_GYRO_RADPS = 0.03
_STEADY_MPS2 = 0.15  # of the force from one window to the next: half a degree to a degree


@dataclass(frozen=True, slots=True, eq=False)
class RestWindow:
    """Means of half a second of stillness."""

    start_ns: int
    accel_mps2: Floats  # (3,)
    gyro_radps: Floats  # (3,)
    temperature_degc: float  # NaN: the unit cannot tell


class RestDetector:
    """Detector; ``rests`` holds every rest so far, as its windows; the last may go on.

    The first window of a stretch and its last are left out: a hand may have been on the unit.
    """

    def __init__(self) -> None:
        self.rests: list[list[RestWindow]] = []
        self.moved_at_s: float | None = None  # when it last moved, since its first sample
        self._began_ns = 0
        self._settling = True
        self._before_mps2: Floats | None = None
        self._cell: int | None = None
        self._parts: list[Floats] = []
        self._last_degc = float("nan")  # some sensors tell it more seldom than once a window

    def push(self, imu: ImuBatch) -> None:
        cells = imu.t_ns // WINDOW_NS
        degc = imu.imu_temperature_degc
        temperature = np.full(len(imu), np.nan) if degc is None else degc
        samples = np.column_stack((imu.accel_mps2, imu.gyro_radps, temperature))
        starts = [0, *(np.flatnonzero(np.diff(cells)) + 1).tolist(), len(cells)]
        for start, stop in pairwise(starts):
            if start == stop:
                continue
            cell = int(cells[start])
            if cell != self._cell:
                if self._cell is None:
                    self._began_ns = cell * WINDOW_NS
                self._close()
                if cell - 1 != self._cell:
                    self._settling = True  # the unit may have been moved meanwhile
                self._cell = cell
            self._parts.append(samples[start:stop])

    def _close(self) -> None:
        if self._cell is None:
            return
        samples = np.vstack(self._parts)
        self._parts = []
        samples = samples[np.isfinite(samples[:, :6]).all(axis=1)]
        if len(samples) < _ENOUGH_SAMPLES:
            self._settling = True
            return
        degc = _usual(samples[:, 6])
        self._last_degc = degc if np.isfinite(degc) else self._last_degc
        start_ns = self._cell * WINDOW_NS
        mean = samples[:, :6].mean(axis=0)
        spread = np.sqrt(samples[:, :6].var(axis=0).reshape(2, 3).sum(axis=1))
        still = spread[0] < _STILL_ACCEL_MPS2 and spread[1] < _STILL_GYRO_RADPS
        before, self._before_mps2 = self._before_mps2, mean[:3]
        steady = before is not None and np.linalg.norm(mean[:3] - before) < _STEADY_MPS2
        if not (still and steady):
            if before is not None or not still:  # the first window of all has nothing before it
                self.moved_at_s = (start_ns - self._began_ns) / NS_PER_S
            if not self._settling and len(self.rests[-1]) > 1:
                self.rests[-1].pop()  # a hand was perhaps reaching for it
            self._settling = True
            return
        if self._settling:
            self.rests.append([])
            self._settling = False
        self.rests[-1].append(RestWindow(start_ns, mean[:3], mean[3:], self._last_degc))


def mean_of(windows: list[RestWindow]) -> RestWindow:
    """Return one window for all of them."""
    return RestWindow(
        windows[0].start_ns,
        np.mean([window.accel_mps2 for window in windows], axis=0),
        np.mean([window.gyro_radps for window in windows], axis=0),
        _usual(np.array([window.temperature_degc for window in windows])),
    )


def seconds(windows: list[RestWindow]) -> float:
    return len(windows) * WINDOW_NS / NS_PER_S


def _usual(degc: Floats) -> float:
    """Return the median of the temperatures that are known: one that was misread moves nothing."""
    known = degc[np.isfinite(degc)]
    return float(np.median(known)) if len(known) else float("nan")
