"""North and east of one unit that may have a compass.

While the heading is open a compass closes it.  What the filter would be without goes on beside,
and satellite fixes decide between the two: a compass that they refute is not heard again, and
when they have made the heading known better than it does, what it said is of no more use.
"""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from base_station.fusion.plane.compass import CONTRADICTS2, CompassUse, turn_by, worth_of
from base_station.fusion.plane.heading_bank import Sighting
from base_station.fusion.plane.horizontal import HorizontalFilter, SavedHorizontal
from base_station.fusion.plane.state import turn_of
from base_station.fusion.port import Bearing

Floats = NDArray[np.float64]


class SavedCompassed(SavedHorizontal, frozen=True):
    deaf: SavedHorizontal | None = None
    compass: CompassUse = msgspec.field(default_factory=CompassUse)


class CompassedFilter(HorizontalFilter):
    """A ``HorizontalFilter`` that goes by a compass where nothing better is known."""

    def __init__(self, scale_std: float, linear_rad: float, wander_radps: float) -> None:
        super().__init__(scale_std, linear_rad, wander_radps)
        self._parameters = scale_std, linear_rad, wander_radps
        self._deaf: HorizontalFilter | None = None  # what it would be without the compass
        self._compass = CompassUse()

    def save(self) -> SavedCompassed:
        own, deaf = super().save(), None if self._deaf is None else self._deaf.save()
        return SavedCompassed(
            own.mean, own.covariance, own.bank, own.drift_std_radps, deaf, self._compass
        )

    def load(self, saved: SavedHorizontal) -> None:
        super().load(saved)
        self._deaf = None
        if isinstance(saved, SavedCompassed):
            self._compass = saved.compass
            if saved.deaf is not None:
                self._deaf = self._other(saved.deaf)

    def go_by(self, bearing: Bearing, *, assumed: bool) -> None:
        """Hear a compass.  ``assumed``: the own frame has been shown with its north for the
        incident frame's, for want of knowledge.
        """
        first, self._compass.said = self._compass.said is None, bearing
        if self._compass.refuted:
            return
        if assumed and first and self.is_linear:
            self.turn_whole(bearing.turn_rad, bearing.std_rad)
        elif self.is_linear:
            known = turn_by(turn_of(*self.moments()), bearing)
            if known is not None:
                super().face(*known)
        else:
            self._close(bearing)

    def _close(self, bearing: Bearing) -> None:
        variance = worth_of(turn_of(*self.moments())[1], bearing)
        if variance == math.inf:
            return
        if self._deaf is None:
            self._deaf = self._other(super().save())
        self.weigh(bearing.turn_rad, variance)

    def hear_anew(self) -> None:
        """The unit has begun anew, and with it its compass."""
        self._compass = CompassUse()

    @property
    def is_refuted(self) -> bool:
        """Fixes have shown the compass to be wrong."""
        return self._compass.refuted

    @property
    def is_contested(self) -> bool:
        """It may yet be refuted."""
        return self._deaf is not None

    def distance2(self, sighting: Sighting) -> float:
        """To what is believed; or, if nearer, to what would be without the compass."""
        distance2 = super().distance2(sighting)
        return distance2 if self._deaf is None else min(distance2, self._deaf.distance2(sighting))

    def update(self, sighting: Sighting) -> None:
        if self._deaf is None:
            super().update(sighting)
            return
        distance2 = super().distance2(sighting)
        self._compass.weigh(distance2, self._deaf.distance2(sighting))
        self._deaf.update(sighting)
        if self._compass.compare(turn_of(*self._deaf.moments())):
            super().load(self._deaf.save())
            self._deaf = None
        elif distance2 < CONTRADICTS2:
            super().update(sighting)

    def adopt(self, mean: Floats, covariance: Floats) -> None:
        self._deaf = None
        super().adopt(mean, covariance)

    def face(self, turn_rad: float, variance: float) -> None:
        self._deaf = None
        super().face(turn_rad, variance)

    def begin(
        self, place_m: tuple[float, float], std_m: float, heading_rad: float, heading_std_rad: float
    ) -> None:
        self._deaf = None
        super().begin(place_m, std_m, heading_rad, heading_std_rad)

    def forget_heading(self, heading_rad: float = 0.0, heading_std_rad: float = math.pi) -> None:
        self._deaf = None
        super().forget_heading(heading_rad, heading_std_rad)

    def forget_place(self) -> None:
        self._deaf = None
        super().forget_place()

    def walk(
        self, north_m: float, east_m: float, moving_s: float, place_var_m2: float, turn_var: float
    ) -> None:
        super().walk(north_m, east_m, moving_s, place_var_m2, turn_var)
        if self._deaf is not None:
            self._deaf.walk(north_m, east_m, moving_s, place_var_m2, turn_var)

    def spread(self, variance_m2: float) -> None:
        super().spread(variance_m2)
        if self._deaf is not None:
            self._deaf.spread(variance_m2)

    def fade(self, keeps: Floats) -> None:
        super().fade(keeps)
        if self._deaf is not None:
            self._deaf.fade(keeps)

    def reframe(self, turn_rad: float, north_m: float, east_m: float) -> None:
        super().reframe(turn_rad, north_m, east_m)
        if self._deaf is not None:
            self._deaf.reframe(turn_rad, north_m, east_m)

    def _other(self, saved: SavedHorizontal) -> HorizontalFilter:
        other = HorizontalFilter(*self._parameters)
        other.load(saved)
        return other
