"""Height filter of one unit: own path, heights of fixes with a slow error, and air pressure.

A barometer shows the height up to its bias, which wanders: slowly with a weather reference, faster
without. Doors and fans make steps of pressure; the path shows no climb, so that a step goes into
the bias and not into the height. A wearer who walks on the level is on a storey, whose height a
plan or the learnt floors give.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion import kernels
from base_station.fusion.interface import BarometricHeight
from base_station.fusion.kalman_update import update
from base_station.fusion.parameters import Parameters
from base_station.fusion.vertical.rides import LiftDetector
from base_station.site import levels
from base_station.site.storeys import Storey
from shared.clock import NS_PER_S

Floats = NDArray[np.float64]

_GATE_STD = 3.0
_UNKNOWN_VAR_M2 = 1e4
_UNSEEN_MOST_S = 86_400.0
_ANTICORRELATED = np.array([[1.0, 0.0, -1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 1.0]])
_OBSERVE_LEVEL = np.array([1.0, 0.0, 0.0])


class SavedHeight(msgspec.Struct, frozen=True):
    numbers: bytes  # ``kernels.HEIGHT``
    air_t_mono_ns: int | None
    lift_detector: LiftDetector


class HeightFilter:
    """State: down in the incident frame, the fixes' slow error in units of their std, and the
    barometer's shift.
    """

    def __init__(self, kind: Parameters) -> None:
        self._kind = kind
        self._air_t_mono_ns: int | None = None  # None: the shift is not known yet
        self._climbing = (
            kind.climb_m_per_sqrt_climb_m**2,
            kind.climb_m_per_sqrt_m**2,
            kind.level_m,
        )
        self._lift_detector = LiftDetector()
        self._height = np.zeros(1, kernels.HEIGHT)
        self._mean: Floats = self._height["mean"][0]
        self._covariance: Floats = self._height["covariance"][0]
        self._path: Floats = self._height["path"][
            0
        ]  # how the own path climbed: ``kernels.predict``
        self._covariance[:] = np.diag([1.0, 1.0, _UNKNOWN_VAR_M2])

    def save(self) -> SavedHeight:
        return SavedHeight(self._height.tobytes(), self._air_t_mono_ns, self._lift_detector)

    def load(self, saved: SavedHeight) -> None:
        self._height[:] = np.frombuffer(saved.numbers, kernels.HEIGHT)
        self._air_t_mono_ns, self._lift_detector = saved.air_t_mono_ns, saved.lift_detector

    @property
    def down_m(self) -> float:
        return float(self._mean.item(0))

    @property
    def variance_m2(self) -> float:
        return float(self._covariance.item(0) + self._path.item(kernels.RIDE_VAR_M2))

    @property
    def walked_level(self) -> bool:
        return self._path.item(kernels.LEVEL_M) > self._kind.level_walk_m

    def reset(self, down_m: float, std_m: float) -> None:
        """Known anew; the barometer's shift is to be found again."""
        self._mean[0] = down_m
        self._covariance[:] = np.diag([std_m**2, 1.0, _UNKNOWN_VAR_M2])
        self._air_t_mono_ns = None

    def shift(self, down_m: float) -> None:
        """The incident frame was moved."""
        self._mean[0] += down_m
        self._mean[2] -= down_m

    def on_outage(self, std_m: float, outage_s: float) -> None:
        """Inflate the variance after a time without any path; the next own path begins without
        error.
        """
        self._covariance[0, 0] += std_m**2
        self._covariance[2, 2] += self._kind.weather_m_per_sqrt_s**2 * min(outage_s, _UNSEEN_MOST_S)
        self._path[kernels.REST_VAR_M2] = 0.0
        self._path[kernels.LEVEL_M] = self._path[kernels.CLIMBED_M] = 0.0

    def predict(
        self, down_m: float, walked_m: float, own_std_m: float = 0.0, *, moves: bool = True
    ) -> None:
        """The own height went on by this much; ``own_std_m`` is how sure the unit is of it, and
        ``moves`` whether its wearer goes anywhere.
        """
        kernels.predict_height(self._height, (down_m, walked_m, own_std_m), moves, self._climbing)
        if moves:
            self._lift_detector.heights.clear()

    def decay_slow_errors(self, keep: float) -> None:
        """Time went by for the fixes' slow error."""
        self._mean[1] *= keep
        self._covariance[1, :] *= keep
        self._covariance[:, 1] *= keep
        self._covariance[1, 1] += 1.0 - keep**2

    def update_gnss(self, down_m: float, std_m: float) -> None:
        """Take a fix's height, unless it cannot be true."""
        part = self._kind.height_slow_part
        observe = np.array([1.0, std_m * math.sqrt(part), 0.0])
        noise_m2 = std_m**2 * (1.0 - part)
        innovation_m = down_m - float(observe @ self._mean)
        spread_m2 = float(observe @ self._covariance @ observe) + noise_m2
        if innovation_m**2 <= _GATE_STD**2 * spread_m2:
            self._update(down_m, noise_m2, observe)

    def update_barometer(self, air: BarometricHeight) -> None:
        kind = self._kind
        since_s = 0.0
        if self._air_t_mono_ns is not None:
            since_s = max(0.0, (air.t_mono_ns - self._air_t_mono_ns) / NS_PER_S)
        self._air_t_mono_ns = air.t_mono_ns
        wander_m = kind.air_m_per_sqrt_s if air.referenced else kind.weather_m_per_sqrt_s
        kernels.update_barometer(
            self._height,
            air.down_m,
            wander_m**2 * since_s,
            kind.air_std_m**2,
            _GATE_STD**2,
        )
        lifted_m = self._lift_detector.update_barometer(air, self._path.item(kernels.RIDDEN_M))
        if lifted_m:  # in the height or in the barometer's shift: their sum is known
            self._covariance += lifted_m**2 * _ANTICORRELATED

    def constrain_to_plan_floors(self, storeys_down_m: Sequence[float]) -> None:
        """Update with the plan's storeys (down) of a wearer in the building who walked on the
        level.
        """
        kind = self._kind
        self._path[kernels.LEVEL_M] = 0.0
        if not storeys_down_m:
            return
        apart2 = np.square(np.array(storeys_down_m) - self.down_m)
        spread_m2 = self.variance_m2 + kind.level_std_m**2
        weights = np.exp(-0.5 * (apart2 - apart2.min()) / spread_m2)
        best = int(apart2.argmin())
        if weights[best] / weights.sum() > kind.level_sure and apart2[best] < 9.0 * spread_m2:
            self._update(storeys_down_m[best], kind.level_std_m**2, _OBSERVE_LEVEL)

    def constrain_to_learnt_floors(self, storeys: Sequence[Storey]) -> None:
        """Update with learnt storeys of a wearer who walked on the level. A storey learnt from
        units' heights is used at most at its own variance, so that a unit does not gain certainty
        from its own height; one that may be a storey off may be on a storey where no one has walked
        yet.
        """
        if not storeys:
            return
        kind, variance_m2 = self._kind, self.variance_m2
        level_m2 = [storey.std_m**2 + kind.level_std_m**2 for storey in storeys]
        apart2 = [
            (storey.down_m - self.down_m) ** 2 / (variance_m2 + own_m2)
            for storey, own_m2 in zip(storeys, level_m2, strict=True)
        ]
        best = min(range(len(storeys)), key=apart2.__getitem__)
        weights = [math.exp(-0.5 * (one - apart2[best])) for one in apart2]
        near = _within(storeys[best].down_m - self.down_m, math.sqrt(variance_m2), levels.LEAST_M)
        sure = near / sum(weights) > kind.level_sure and apart2[best] < _GATE_STD**2
        if sure and variance_m2 > level_m2[best]:
            noise_m2 = 1.0 / (1.0 / level_m2[best] - 1.0 / variance_m2)
            self._update(storeys[best].down_m, noise_m2, _OBSERVE_LEVEL)

    def _update(self, down_m: float, noise_m2: float, observe: Floats) -> None:
        """Kalman update with a height; ``observe`` (3,): Jacobian of the measurement."""
        posterior = update(
            self._mean,
            self._covariance,
            np.array([down_m]),
            np.array([[noise_m2]]),
            observe[np.newaxis],
        )
        self._mean[:], self._covariance[:] = posterior


def _within(off_m: float, std_m: float, reach_m: float) -> float:
    """Probability that a height is nearer than that to what lies so far from its mean."""
    over, under = (
        math.erf((off_m + side_m) / max(math.sqrt(2.0) * std_m, 1e-9))
        for side_m in (reach_m, -reach_m)
    )
    return 0.5 * (over - under)


def climb_var_m2(kind: Parameters, climbed_m: float, walked_m: float) -> float:
    return kind.climb_m_per_sqrt_climb_m**2 * abs(climbed_m) + kind.climb_m_per_sqrt_m**2 * walked_m
