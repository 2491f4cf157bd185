"""Compass-aided horizontal filter.

A compass closes an open heading. A filter without it runs beside, and fixes decide between the two:
a rejected compass is not used again, and once fixes know the heading better the compass is not
needed.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.horizontal.compass import (
    CONTRADICTS2,
    CompassTest,
    equivalent_variance,
    fused_turn,
)
from base_station.fusion.horizontal.heading_hypotheses import GnssObservation
from base_station.fusion.horizontal.horizontal import HorizontalFilter, SavedHorizontal
from base_station.fusion.horizontal.state import turn_and_std
from base_station.fusion.interface import CompassHeading

Floats = NDArray[np.float64]


class SavedCompassAided(SavedHorizontal, frozen=True):
    without_compass: SavedHorizontal | None = None
    compass: CompassTest = msgspec.field(default_factory=CompassTest)


class CompassAidedFilter(HorizontalFilter):
    """``HorizontalFilter`` that uses a compass while the heading is not known better."""

    def __init__(self, scale_std: float, linear_rad: float, wander_radps: float) -> None:
        super().__init__(scale_std, linear_rad, wander_radps)
        self._linear_and_wander = linear_rad, wander_radps
        self._without_compass: HorizontalFilter | None = None  # the estimate without the compass
        self._compass = CompassTest()

    def save(self) -> SavedCompassAided:
        own, without_compass = (
            super().save(),
            None if self._without_compass is None else self._without_compass.save(),
        )
        return SavedCompassAided(
            own.mean,
            own.covariance,
            own.hypotheses,
            own.drift_std_radps,
            without_compass,
            self._compass,
        )

    def load(self, saved: SavedHorizontal) -> None:
        super().load(saved)
        self._without_compass = None
        if isinstance(saved, SavedCompassAided):
            self._compass = saved.compass
            if saved.without_compass is not None:
                self._without_compass = self._copy_of(saved.without_compass)

    def update_compass(self, heading: CompassHeading, *, assumed: bool) -> None:
        """Update with a compass heading. ``assumed``: the own frame has been shown with its north
        as that of the incident frame, as nothing else was known.
        """
        first, self._compass.last_heading = self._compass.last_heading is None, heading
        if self._compass.is_rejected:
            return
        if assumed and first and self.is_linear:
            self.rotate_frame(heading.turn_rad, heading.std_rad)
        elif self.is_linear:
            known = fused_turn(turn_and_std(*self.moments()), heading)
            if known is not None:
                super().set_heading(*known)
        else:
            self._close(heading)

    def _close(self, heading: CompassHeading) -> None:
        variance = equivalent_variance(turn_and_std(*self.moments())[1], heading)
        if variance == math.inf:
            return
        if self._without_compass is None:
            self._without_compass = self._copy_of(super().save())
        self.update_open_heading(heading.turn_rad, variance)

    def reset_compass(self) -> None:
        """The unit has begun anew, and with it its compass."""
        self._compass = CompassTest()

    @property
    def is_compass_rejected(self) -> bool:
        """Fixes have shown the compass to be wrong."""
        return self._compass.is_rejected

    @property
    def is_contested(self) -> bool:
        """True while fixes may still reject the compass."""
        return self._without_compass is not None

    def distance2(self, observation: GnssObservation) -> float:
        """Squared distance to the estimate, or to the one without the compass where
        that is less.
        """
        distance2 = super().distance2(observation)
        return (
            distance2
            if self._without_compass is None
            else min(distance2, self._without_compass.distance2(observation))
        )

    def update(self, observation: GnssObservation) -> None:
        if self._without_compass is None:
            super().update(observation)
            return
        distance2 = super().distance2(observation)
        self._compass.add_fix(distance2, self._without_compass.distance2(observation))
        self._without_compass.update(observation)
        if self._compass.is_useless(turn_and_std(*self._without_compass.moments())):
            super().load(self._without_compass.save())
            self._without_compass = None
        elif distance2 < CONTRADICTS2:
            super().update(observation)

    def set_state(self, mean: Floats, covariance: Floats) -> None:
        self._without_compass = None
        super().set_state(mean, covariance)

    def set_heading(self, turn_rad: float, variance: float) -> None:
        self._without_compass = None
        super().set_heading(turn_rad, variance)

    def set_scale_std(self, std: float) -> None:
        super().set_scale_std(std)
        if self._without_compass is not None:
            self._without_compass.set_scale_std(std)

    def set_start(
        self, place_m: tuple[float, float], std_m: float, heading_rad: float, heading_std_rad: float
    ) -> None:
        self._without_compass = None
        super().set_start(place_m, std_m, heading_rad, heading_std_rad)

    def reset_heading(self, heading_rad: float = 0.0, heading_std_rad: float = math.pi) -> None:
        self._without_compass = None
        super().reset_heading(heading_rad, heading_std_rad)

    def reset_place(self) -> None:
        self._without_compass = None
        super().reset_place()

    def predict(
        self, north_m: float, east_m: float, moving_s: float, place_var_m2: float, turn_var: float
    ) -> None:
        super().predict(north_m, east_m, moving_s, place_var_m2, turn_var)
        if self._without_compass is not None:
            self._without_compass.predict(north_m, east_m, moving_s, place_var_m2, turn_var)

    def inflate_place(self, variance_m2: float) -> None:
        super().inflate_place(variance_m2)
        if self._without_compass is not None:
            self._without_compass.inflate_place(variance_m2)

    def decay_slow_errors(self, keeps: Floats) -> None:
        super().decay_slow_errors(keeps)
        if self._without_compass is not None:
            self._without_compass.decay_slow_errors(keeps)

    def reframe(self, turn_rad: float, north_m: float, east_m: float) -> None:
        super().reframe(turn_rad, north_m, east_m)
        if self._without_compass is not None:
            self._without_compass.reframe(turn_rad, north_m, east_m)

    def _copy_of(self, saved: SavedHorizontal) -> HorizontalFilter:
        other = HorizontalFilter(self._scale_std, *self._linear_and_wander)
        other.load(saved)
        return other
