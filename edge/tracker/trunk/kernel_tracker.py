"""The part of a trunk's tracker outside its kernel: samples into the ring, rows out of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.interface import TrackBatch
from edge.tracker.preprocessing.preprocess import limits_of, new_input_state, preprocess_batch
from edge.tracker.preprocessing.sample_ring import Ring, new_ring, reach
from edge.tracker.preprocessing.sample_times import regular_time
from edge.tracker.track_rows import join_rows, rows_of
from edge.tracker.trunk.state import TrunkConfig, TrunkState, begin_trunk
from shared.earth_field import EarthField
from shared.path_noise import PathNoise

Kernel = Callable[[Ring, NDArray[Any], Any, bool], int]  # returns one past the last row released


class KernelTracker:
    """Tracker whose kernel takes the samples of a ring; see ``Tracker``."""

    def __init__(
        self,
        description: SensorDescription,
        states: NDArray[Any],
        kernel: Kernel,
        config: Any,
    ) -> None:
        """``states``: one record with a ``trunk``; ``config`` has the ``trunk``'s likewise."""
        trunk: TrunkConfig = config.trunk
        if description.gyro_bias_std_radps is not None:
            trunk = trunk._replace(unknown_bias_radps=description.gyro_bias_std_radps)
            config = config._replace(trunk=trunk)
        self.description = description
        self.config = config
        self._gate = new_input_state(description, trunk.saturation_ratio)
        self._ring = new_ring(description.rate_hz)
        self._limits = limits_of(description)
        self._states = states
        self._trunk = states["trunk"]
        self._kernel = kernel
        begin_trunk(self._trunk[0], description)

    @property
    def path_noise(self) -> PathNoise:
        """Process noise of the rows; see ``Tracker``. The heading does no random walk."""
        trunk: TrunkConfig = self.config.trunk
        return PathNoise(trunk.length_std, trunk.path_std_m_per_sqrt_m)

    def push(self, batch: ImuBatch) -> TrackBatch:
        """Take samples; return the rows that have become final."""
        parts = preprocess_batch(
            self._ring, self._trunk, self._gate, self._limits, self.config.trunk.gap_s, batch
        )
        return join_rows([self._work(final=lacks_good_samples) for lacks_good_samples in parts])

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """Not used: where the sensor faces on its wearer is not known, nor so where north is."""
        del field, t_ns

    def finish(self) -> TrackBatch:
        """Return the rows still held back; the tracker is used up."""
        return self._work(final=True)

    def _work(self, *, final: bool) -> TrackBatch:
        first = int(self._trunk["released"][0])
        stop = self._kernel(self._ring, self._states, self.config, final)
        return rows_of(self._ring, first, stop)


def new_states(dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return one empty record."""
    return np.zeros(1, dtype)


@njit()
def take_times(ring: Ring, trunk: TrunkState, config: TrunkConfig, final: bool) -> None:
    """Give every sample its regular time, as far as its followers are there."""
    mask = len(ring) - 1
    while trunk.timed < trunk.received:
        k = trunk.timed
        since_s = ring[(trunk.received - 1) & mask].arrival_s - ring[k & mask].arrival_s
        if not final and since_s <= config.late_delivery_s and trunk.received < reach(ring, k):
            break
        stop = min(trunk.received, reach(ring, k))
        ring[k & mask].t_s = regular_time(ring, k, stop, config.late_delivery_s)
        trunk.timed = k + 1


@njit()
def is_past(ring: Ring, trunk: TrunkState, k: int, wait_s: float) -> bool:
    """True when samples up to ``wait_s`` after ``k`` have their times, or no more can be held."""
    mask = len(ring) - 1
    since_s = ring[(trunk.timed - 1) & mask].t_s - ring[k & mask].t_s
    return bool(since_s > wait_s or trunk.timed >= reach(ring, k))
