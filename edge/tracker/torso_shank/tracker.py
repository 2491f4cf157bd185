"""Tracker by the method of Chiu (2011): a torso whose velocity a shank puts right once a stride.

The shank shows when its leg is straight and upright, and how fast the body goes there
(``leg_swing``); between two such instants the acceleration of the torso is integrated (``stride``).
Heading and height are the torso's, by ``edge.tracker.trunk``.  While the shank is silent, or shows
no instants though the torso makes steps, those count as ``waist`` has them, with the lengths that
the shank has shown them to have (``torso_steps``).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from edge.samples import ImuBatch
from edge.tracker.interface import BodyDimensions, TrackBatch, WornSensor
from edge.tracker.preprocessing.preprocess import limits_of, new_input_state, preprocess_batch
from edge.tracker.preprocessing.sample_ring import Ring, new_ring, reach
from edge.tracker.torso_shank.movement import move
from edge.tracker.torso_shank.shank_samples import (
    NEVER_NS,
    all_arrived_ns,
    take_backlog,
    take_shank_times,
    take_shank_until,
)
from edge.tracker.torso_shank.state import (
    SHANK,
    TORSO_SHANK,
    TorsoShankConfig,
    leg_length_m,
)
from edge.tracker.track_rows import join_rows, rows_of
from edge.tracker.trunk.dead_reckoning import release_standing
from edge.tracker.trunk.follow import follow_sample
from edge.tracker.trunk.kernel_tracker import is_past, new_states, take_times
from edge.tracker.trunk.state import begin_trunk
from shared.earth_field import EarthField
from shared.path_noise import PathNoise

SHANK_PLACE = "shank"


class TorsoShankTracker:
    """Walking velocity update; see ``MultiSensorTracker``.  The rows are the torso's."""

    def __init__(
        self,
        sensors: Mapping[str, WornSensor],
        dimensions: BodyDimensions,
        config: TorsoShankConfig | None = None,
    ) -> None:
        self.config = config or TorsoShankConfig()
        self._torso, self._shank = new_states(TORSO_SHANK), new_states(SHANK)
        leg_m, leg_std = leg_length_m(dimensions, self.config)
        self._shank["walked_ns"] = NEVER_NS
        self._torso["leg_length_m"], self._torso["leg_std"] = leg_m, leg_std
        self._inputs = {
            name: _SensorInput(
                sensor,
                self._shank["trunk"]
                if sensor.place == SHANK_PLACE
                else self._torso["waist"]["trunk"],
                self.config,
            )
            for name, sensor in sensors.items()
        }
        shank = next(name for name in sensors if sensors[name].place == SHANK_PLACE)
        (torso,) = (name for name in sensors if name != shank)
        self._torso_ring, self._shank_ring = self._inputs[torso].ring, self._inputs[shank].ring

    @property
    def path_noise(self) -> PathNoise:
        """Process noise of the rows; see ``Tracker``. The heading does no random walk."""
        leg_std = float(self._torso["leg_std"][0])
        return PathNoise(leg_std, self.config.trunk.path_std_m_per_sqrt_m)

    def push(self, sensor: str, batch: ImuBatch) -> TrackBatch:
        """Take samples of one sensor; return the rows that have become final."""
        return join_rows([self._work(final=False) for _ in self._inputs[sensor].take(batch)])

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """Not used: where the sensor faces on its wearer is not known, nor so where north is."""
        del field, t_ns

    def finish(self) -> TrackBatch:
        """Return the rows still held back; the tracker is used up."""
        return self._work(final=True)

    def _work(self, *, final: bool) -> TrackBatch:
        first = int(self._torso["waist"]["trunk"]["released"][0])
        stop = walk(
            self._torso_ring, self._torso, self._shank_ring, self._shank, self.config, final
        )
        return rows_of(self._torso_ring, first, stop)


class _SensorInput:
    """Samples of one sensor on their way into its ring."""

    def __init__(self, sensor: WornSensor, trunk: NDArray[Any], config: TorsoShankConfig) -> None:
        self.ring = new_ring(sensor.description.rate_hz)
        self._gate = new_input_state(sensor.description, config.trunk.saturation_ratio)
        self._limits = limits_of(sensor.description)
        self._trunk = trunk
        self._gap_s = config.trunk.gap_s
        begin_trunk(trunk[0], sensor.description)

    def take(self, batch: ImuBatch) -> Iterator[bool]:
        """Put the samples into the ring, part by part."""
        return preprocess_batch(
            self.ring, self._trunk, self._gate, self._limits, self._gap_s, batch
        )


@njit(cache=True)
def walk(
    ring: Ring,
    states: NDArray[Any],
    shank_ring: Ring,
    shank_states: NDArray[Any],
    config: TorsoShankConfig,
    final: bool,
) -> int:
    """Take every sample as far as it can go; return one past the last released row."""
    state, shank = states[0], shank_states[0]
    trunk = state.waist.trunk
    arrived_ns = all_arrived_ns(ring, trunk, config, final)
    take_times(ring, trunk, config.trunk, final)
    take_shank_times(shank_ring, shank, arrived_ns, config, final)
    angle_b_rad, scratch_n = np.zeros(3), np.zeros(2)
    take_backlog(shank_ring, shank, angle_b_rad, config)
    while trunk.walked < trunk.timed:
        k = trunk.walked
        if not final and not is_past(ring, trunk, k, config.trunk.lookahead_s):
            break
        t_ns = ring[k & (len(ring) - 1)].t_ns
        known = take_shank_until(shank_ring, shank, t_ns, arrived_ns, angle_b_rad, config)
        if not known and trunk.timed < reach(ring, k):
            break
        follow_sample(ring, trunk, k, angle_b_rad, config.trunk)
        trunk.walked = k + 1
        move(ring, state, shank, k, scratch_n, config)
        release_standing(ring, trunk, k, config.trunk)
    if final:
        trunk.released = trunk.walked
    return int(trunk.released)
