"""Horizontal filter of one unit: linear in turn and scale, with heading hypotheses while the
heading is open.

The unit's path is known up to a turn, a scale and a shift. With the complex number ``c + i s = k
exp(i psi)`` (scale k, heading correction psi) an increment ``(dn, de)`` of the own path moves the
wearer by

    north += c dn - s de        east += s dn + c de

which is *linear* in ``[north, east, c, s, b_n, b_e, k_n, k_e, w]``. ``b`` and ``k`` are slow parts
of the fixes' error, each of unit variance (first-order Gauss-Markov), so that minutes of fixes do
not average them away: ``b`` is the receiver's own and lasts a minute, ``k`` is the common-mode
error and lasts for much of an incident (see ``gnss.common_mode_error``). ``w`` is the drift rate of
the own heading while the wearer moves, learnt outside and valid inside. A late fix is an
observation of the present state less the path walked since.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion import kernels
from base_station.fusion.gaussian import jeffrey_update
from base_station.fusion.horizontal.heading_hypotheses import (
    GnssObservation,
    HeadingHypotheses,
    SavedHypotheses,
    slow_error_jacobian,
)
from base_station.fusion.horizontal.state import (
    PATH,
    PLACE_AND_SLOW,
    SLOW,
    place_jacobian,
    turn_and_std,
)
from base_station.fusion.kalman_update import update
from base_station.fusion.kernels import DRIFT, PLANE, STATES, HorizontalEstimate
from shared.geo import wrap_pi

Floats = NDArray[np.float64]

_UNKNOWN_VAR_M2 = 1e8
KEEPS_ON = 0.9  # of its drift: that much less is no change
REOPEN = 1.5  # times the width at which one hypothesis was enough


class SavedHorizontal(msgspec.Struct, frozen=True):
    mean: list[float]
    covariance: list[list[float]]
    hypotheses: SavedHypotheses | None
    drift_std_radps: float


class HorizontalFilter:
    """Begins at the origin with the own frame's heading taken for the incident frame's."""

    def __init__(self, scale_std: float, linear_rad: float, wander_radps: float) -> None:
        """``linear_rad``: heading standard deviation from which one hypothesis will do;
        ``wander_radps``: of the drift rate in a minute of walking.
        """
        self._scale_std = scale_std
        self._linear_rad = linear_rad
        self._wander_var = wander_radps**2 / 60.0
        self._drift_std_radps = 0.0
        self._plane = np.zeros(1, PLANE)
        self._mean: Floats = self._plane["mean"][0]
        self._covariance: Floats = self._plane["covariance"][0]
        self._mean[2] = 1.0
        self._covariance[SLOW, SLOW] = np.eye(4)
        self._hypotheses: HeadingHypotheses | None = None  # where it is, these mirror its moments
        self._stale = False  # and is behind it

    def save(self) -> SavedHorizontal:
        hypotheses = None if self._hypotheses is None else self._hypotheses.save()
        mean, covariance = self._current()
        return SavedHorizontal(
            mean.tolist(), covariance.tolist(), hypotheses, self._drift_std_radps
        )

    def load(self, saved: SavedHorizontal) -> None:
        self._mean[:], self._covariance[:] = saved.mean, saved.covariance
        self._drift_std_radps = saved.drift_std_radps
        self._hypotheses = (
            None if saved.hypotheses is None else HeadingHypotheses.restore(saved.hypotheses)
        )

    @property
    def is_linear(self) -> bool:
        """One heading is left."""
        return self._hypotheses is None

    def moments(self) -> tuple[Floats, Floats]:
        """Mean (9,) and covariance (9, 9) of the whole state."""
        mean, covariance = self._current()
        return mean.copy(), covariance.copy()

    def estimate_before(self, north_m: float, east_m: float) -> HorizontalEstimate:
        """Place before this much of own path was walked, and turn, as it looks now."""
        return HorizontalEstimate(*kernels.estimate_before(*self._current(), north_m, east_m))

    def set_state(self, mean: Floats, covariance: Floats) -> None:
        """Go on from what another filter of the same state came to."""
        self._hypotheses = None
        self._mean[:], self._covariance[:] = mean, covariance

    def set_posterior(self, mean: Floats, covariance: Floats) -> None:
        """Begin again with ``[north, east, c, s, w]``; of fixes' slow errors nothing is known."""
        whole, spread = np.zeros(STATES), np.zeros((STATES, STATES))
        whole[PATH], spread[np.ix_(PATH, PATH)] = mean, covariance
        spread[SLOW, SLOW] = np.eye(4)
        self.set_state(whole, spread)
        self._open_heading(self._linear_rad)

    def _open_heading(self, from_rad: float) -> None:
        """Past so wide a heading one hypothesis will not do."""
        mean, covariance = self._mean[:DRIFT], self._covariance[:DRIFT, :DRIFT]
        if self._hypotheses is None and turn_and_std(mean, covariance)[1] > from_rad:
            self._hypotheses = HeadingHypotheses.from_gaussian(mean, covariance)
            self._stale = True

    def set_drift_std(self, std_radps: float) -> float:
        """Set the prior deviation of the drift rate (rad/s). A larger one than before inflates the
        variance; a smaller one (rests or a compass now hold the heading) scales the drift down, by
        the share that is returned.
        """
        before_radps = self._drift_std_radps
        if KEEPS_ON * before_radps < std_radps <= before_radps:
            return 1.0
        self._drift_std_radps = std_radps
        if self._hypotheses is None and std_radps > before_radps:
            self._covariance[DRIFT, DRIFT] += std_radps**2 - before_radps**2
        if self._hypotheses is not None or std_radps > before_radps:
            return 1.0
        share = std_radps / before_radps
        self._mean[DRIFT] *= share
        self._covariance[DRIFT, :] *= share
        self._covariance[:, DRIFT] *= share
        return share

    def set_scale_std(self, std: float) -> None:
        """Set the prior deviation of the scale. A larger one than before inflates the variance; a
        smaller one holds for a heading that becomes known from now on.
        """
        before, self._scale_std = self._scale_std, std
        if self._hypotheses is None and std > before:
            self._inflate_scale(std**2 - before**2)

    def set_start(
        self, place_m: tuple[float, float], std_m: float, heading_rad: float, heading_std_rad: float
    ) -> None:
        """The own frame's origin and the heading of its north."""
        self._current()
        self._hypotheses = None
        self._mean[:2] = place_m
        self._reset_place_var(std_m**2)
        if heading_std_rad > self._linear_rad:
            self.reset_heading(heading_rad, heading_std_rad)
            return
        along = np.array([math.cos(heading_rad), math.sin(heading_rad)])
        across = np.array([-along[1], along[0]])
        self._mean[2:4] = along
        self._reset_heading_var(
            self._scale_std**2 * np.outer(along, along)
            + heading_std_rad**2 * np.outer(across, across)
        )
        self._forget_drift()

    def reset_heading(self, heading_rad: float = 0.0, heading_std_rad: float = math.pi) -> None:
        own = np.ix_(PLACE_AND_SLOW, PLACE_AND_SLOW)
        mean, covariance = self._current()
        self._hypotheses = HeadingHypotheses.from_prior(
            mean[PLACE_AND_SLOW], covariance[own], heading_rad, heading_std_rad
        )
        self._stale = True

    def reset_place(self) -> None:
        if self._hypotheses is not None:
            self._hypotheses.reset_place(_UNKNOWN_VAR_M2)
            self._stale = True
        else:
            self._reset_place_var(_UNKNOWN_VAR_M2)

    def predict(
        self, north_m: float, east_m: float, moving_s: float, place_var_m2: float, turn_var: float
    ) -> None:
        """The own path went on by this much, moving for so long."""
        if self._hypotheses is not None:
            self._hypotheses.predict(north_m, east_m, place_var_m2, turn_var)
            self._stale = True
            return
        drift_var = self._wander_var * moving_s
        kernels.predict_horizontal(
            self._plane, north_m, east_m, moving_s, place_var_m2, turn_var, drift_var
        )

    def inflate_place(self, variance_m2: float) -> None:
        """The wearer may have got away from the path by so much."""
        if self._hypotheses is not None:
            self._hypotheses.inflate_place(variance_m2)
            self._stale = True
        else:
            self._covariance[0, 0] += variance_m2
            self._covariance[1, 1] += variance_m2

    def decay_slow_errors(self, keeps: Floats) -> None:
        """Time went by for the fixes' slow errors: (4,) of each what is left."""
        if self._hypotheses is not None:
            self._hypotheses.decay_slow_errors(keeps)
            self._stale = True
            return
        self._mean[SLOW] *= keeps
        self._covariance[SLOW, :] *= keeps[:, None]
        self._covariance[:, SLOW] *= keeps
        self._covariance[SLOW, SLOW] += np.diag(1.0 - keeps**2)

    def distance2(self, observation: GnssObservation) -> float:
        """Squared Mahalanobis distance of an observation, chi-square of two degrees of freedom."""
        if self._hypotheses is not None:
            return self._hypotheses.distance2(observation)
        place, observe, noise = _linear(observation)
        innovation = place - observe @ self._mean
        spread = observe @ self._covariance @ observe.T + noise
        return float(innovation @ np.linalg.solve(spread, innovation))

    def update(self, observation: GnssObservation) -> None:
        self._open_heading(REOPEN * self._linear_rad)
        if self._hypotheses is None:
            place, observe, noise = _linear(observation)
            posterior = update(self._mean, self._covariance, place, noise, observe)
            self._mean[:], self._covariance[:] = posterior
            return
        self._hypotheses.update(observation)
        self._close_heading()

    def update_open_heading(self, turn_rad: float, variance: float) -> None:
        """The heading correction was measured; only while it is open."""
        assert self._hypotheses is not None
        self._hypotheses.update_heading(turn_rad, variance)
        self._close_heading()

    def rotate_frame(self, turn_rad: float, std_rad: float) -> None:
        """The own frame was shown with its north for the incident frame's, and is turned; only
        where one heading is left.
        """
        self.reframe(turn_rad, 0.0, 0.0)
        north_m, east_m, c, s = self._mean[:4]
        by = np.array([-east_m, north_m, -s, c, *[0.0] * (STATES - 4)])
        self._covariance += std_rad**2 * np.outer(by, by)

    def set_heading(self, turn_rad: float, variance: float) -> None:
        """The heading correction has come to be known as this; only where one heading is left."""
        mean, covariance = self.moments()
        c, s = float(mean[2]), float(mean[3])
        scale2 = c * c + s * s
        observe = np.zeros((1, STATES))
        observe[0, 2:4] = -s / scale2, c / scale2
        to = observe @ mean + wrap_pi(turn_rad - math.atan2(s, c))
        mean, covariance = jeffrey_update(mean, covariance, observe, to, np.array([[variance]]))
        mean[2:4] *= math.sqrt(scale2) / math.hypot(mean[2], mean[3])
        self._mean[:], self._covariance[:] = mean, covariance

    def _close_heading(self) -> None:
        """Known so well, one hypothesis is enough."""
        self._stale = True
        if turn_and_std(*self.moments())[1] < self._linear_rad:
            self._hypotheses = None
            self._inflate_scale(self._scale_std**2)
            self._forget_drift()

    def _inflate_scale(self, variance: float) -> None:
        along = self._mean[2:4] / np.linalg.norm(self._mean[2:4])
        self._covariance[2:4, 2:4] += variance * np.outer(along, along)

    def reframe(self, turn_rad: float, north_m: float, east_m: float) -> None:
        cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        if self._hypotheses is not None:
            self._hypotheses.reframe(turn_rad, turn, np.array([north_m, east_m]))
            self._stale = True
            return
        whole = np.eye(STATES)
        whole[:DRIFT, :DRIFT] = np.kron(np.eye(DRIFT // 2), turn)
        self._mean[:] = whole @ self._mean
        self._mean[:2] += north_m, east_m
        self._covariance[:] = whole @ self._covariance @ whole.T

    def _current(self) -> tuple[Floats, Floats]:
        """Mean and covariance, abreast of the bank."""
        if self._stale and self._hypotheses is not None:
            self._mean[:DRIFT], self._covariance[:DRIFT, :DRIFT] = self._hypotheses.moments()
            self._forget_drift()
        self._stale = False
        return self._mean, self._covariance

    def _forget_drift(self) -> None:
        self._mean[DRIFT] = 0.0
        self._covariance[DRIFT, :] = self._covariance[:, DRIFT] = 0.0
        self._covariance[DRIFT, DRIFT] = self._drift_std_radps**2

    def _reset_place_var(self, variance_m2: float) -> None:
        covariance = self._covariance
        covariance[:2, :] = 0.0
        covariance[:, :2] = 0.0
        covariance[0, 0] = covariance[1, 1] = variance_m2

    def _reset_heading_var(self, covariance: Floats) -> None:
        self._covariance[2:4, :] = 0.0
        self._covariance[:, 2:4] = 0.0
        self._covariance[2:4, 2:4] = covariance


def _linear(observation: GnssObservation) -> tuple[Floats, Floats, Floats]:
    """Measurement (2,), its matrix (2, 9) and its covariance (2, 2)."""
    observe = place_jacobian(observation.since_north_m, observation.since_east_m)
    observe[:, SLOW] = slow_error_jacobian(observation)
    place = np.array([observation.north_m, observation.east_m])
    return place, observe, observation.white_m2 * np.eye(2)
