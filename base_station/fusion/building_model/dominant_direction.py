"""Dominant direction of a building: wearers inside walk along walls, in two directions at right
angles.

A straight segment of the own path is a measurement of the heading where it fits a wall (heuristic
drift elimination: Borenstein and Ojeda 2009). The direction (axis) is not known beforehand: it is
as good as the heading with which a wearer came in, and the best one corrects the others.
"""

from __future__ import annotations

import math

import msgspec

from base_station.fusion.building_model.straight_segments import (
    OFF,
    QUARTER_RAD,
    SHOWN,
    Axis,
    DirectionWeights,
    Drift,
    StraightSegment,
    along_wall,
    append_segment,
    wrap_quarter,
)

WINDOW = 16  # last legs, one after each turn, from which an axis is estimated
ABOUT_RAD = math.radians(8.0)  # further legs of an axis add nothing to its direction
WIDE_RAD = math.radians(10.0)  # a direction less known than this may be any by a single leg
SETTLED_RAD = math.radians(5.0)  # and is known again by several
KEPT = 0.3  # of the belief in a direction, with which it is held on to
SHARED_STD_RAD = math.radians(1.0)  # walls of one building are not quite parallel
SHARED_LOG_ODDS = 1.0  # log odds from which legs show an axis that others know
EITHER_RAD = QUARTER_RAD / 2.0 / OFF  # less known than this it may be the next wall as well
LEAST = 1e-9  # variance by which heading and axis differ
STEADY = Drift()


class DominantDirectionFilter(msgspec.Struct):
    """One unit's heading correction and the building's axis, as one normal distribution: what is
    not known of the one is not known of the other.
    """

    segments: list[StraightSegment] = msgspec.field(default_factory=list)  # the last ones
    axis: Axis | None = None  # in the incident frame
    turn_variance: float = 0.0
    crossed: float = 0.0  # covariance of both
    is_contradicted: bool = False  # walls known by other units are not these

    def update(
        self,
        segment: StraightSegment,
        turn_rad: float,
        variance: float,
        known: Axis | None = None,
        drift: Drift = STEADY,
    ) -> tuple[float, float]:
        """Heading correction and variance after a leg, given what they were before: as far as the
        leg may be one along a wall (probabilistic data association, Bar-Shalom and Tse 1975).
        Where an axis is ``known`` to others, legs need only fit that one to show it.
        """
        append_segment(
            self.segments,
            msgspec.structs.replace(segment, turn_rad=turn_rad, turn_variance=variance),
        )
        del self.segments[:-WINDOW]
        if self.axis is None:
            return self._search(turn_rad, variance, known, drift)
        self._align_variance(variance)
        held = self._held(turn_rad, variance)
        shown = DirectionWeights.of(self.segments, drift, held.direction_rad).with_prior(
            held.variance
        )
        if shown.evidence < 0.0:
            return turn_rad, variance  # people do not walk along walls here
        off_rad = shown.direction_rad - held.direction_rad
        if held.variance > WIDE_RAD**2:
            if shown.evidence < SHOWN or shown.variance > SETTLED_RAD**2:
                return turn_rad, variance
        elif shown.kept > KEPT:
            return self._follow(segment, held, turn_rad, variance)
        else:
            return turn_rad, self._reject_axis(off_rad**2 + shown.variance, variance)
        self.segments.clear()  # their information is used
        return self._condition(held, (off_rad, shown.variance), turn_rad, variance)

    def _reject_axis(self, off2: float, variance: float) -> float:
        """Drop the axis: the heading was turned, or walls here have another angle. The variance is
        set so that the 95 % region holds both.
        """
        self.axis, self.is_contradicted = None, True
        self.segments.clear()
        return max(variance, off2 / 4.0)

    def _search(
        self, turn_rad: float, variance: float, known: Axis | None, drift: Drift
    ) -> tuple[float, float]:
        """Update while no axis is held: search for one."""
        about_rad = 0.0 if known is None else known.direction_rad - turn_rad
        weighed = DirectionWeights.of(self.segments, drift, about_rad)
        shown = weighed.with_flat_prior()
        if shown.evidence > SHOWN:
            return self._begin(shown.direction_rad, drift)
        if known is not None:
            shown = weighed.with_prior(known.variance + variance)
            if shown.evidence > SHARED_LOG_ODDS and shown.variance < SETTLED_RAD**2:
                return self._begin(shown.direction_rad, drift)
        return turn_rad, variance

    def _held(self, turn_rad: float, variance: float) -> Axis:
        """The axis in the own frame, by that heading correction and its variance."""
        assert self.axis is not None
        apart = variance - 2.0 * self.crossed + self.axis.variance
        return Axis(self.axis.direction_rad - turn_rad, max(apart, LEAST))

    def _follow(
        self, segment: StraightSegment, held: Axis, turn_rad: float, variance: float
    ) -> tuple[float, float]:
        """``held``: the axis in the own frame."""
        spread = held.variance + segment.variance
        gain = held.variance / spread
        off_rad = wrap_quarter(segment.direction_rad - held.direction_rad)
        along = along_wall(off_rad, spread)
        learnt = along * spread - along * (1.0 - along) * off_rad**2  # less where it may be none
        posterior = along * gain * off_rad, held.variance - gain**2 * learnt
        return self._condition(held, posterior, turn_rad, variance)

    def _condition(
        self, held: Axis, posterior: tuple[float, float], turn_rad: float, variance: float
    ) -> tuple[float, float]:
        """The axis in the own frame, ``held`` so far, has come to be known as so far off that,
        with a variance.
        """
        assert self.axis is not None
        off_rad, learnt = posterior[0], held.variance - posterior[1]
        turn_gain = (self.crossed - variance) / held.variance
        axis_gain = (self.axis.variance - self.crossed) / held.variance
        self.crossed -= turn_gain * axis_gain * learnt
        self.axis = Axis(
            self.axis.direction_rad + axis_gain * off_rad,
            self.axis.variance - axis_gain**2 * learnt,
        )
        self.turn_variance = variance - turn_gain**2 * learnt
        return turn_rad + turn_gain * off_rad, self.turn_variance

    def fuse_shared(self, other: Axis, turn_rad: float, variance: float) -> tuple[float, float]:
        """Heading correction and variance after another unit's axis, used at most at its own
        variance.
        """
        axis = self.axis
        if axis is None:
            return turn_rad, variance
        self._align_variance(variance)
        off_rad = wrap_quarter(other.direction_rad - axis.direction_rad)
        grown = axis.variance - other.variance
        same = off_rad**2 < 9.0 * (axis.variance + other.variance + SHARED_STD_RAD**2)
        if grown <= 0.0 or not same or axis.variance > EITHER_RAD**2:
            return turn_rad, variance
        gain = grown / (grown + SHARED_STD_RAD**2)
        hangs_on = self.crossed / axis.variance
        self.axis = Axis(axis.direction_rad + gain * off_rad, axis.variance - gain * grown)
        self.crossed -= hangs_on * gain * grown
        self.turn_variance = variance - hangs_on**2 * gain * grown
        return turn_rad + hangs_on * gain * off_rad, self.turn_variance

    def _begin(self, direction_rad: float, drift: Drift) -> tuple[float, float]:
        """Begin with an axis of this direction in the own frame. Its variance is that of the
        heading when it was known best; the segments from there on are followed again, which
        corrects the drift since. Returns heading correction and variance after the last segment.
        """
        first = min(range(len(self.segments)), key=lambda row: self.segments[row].turn_variance)
        start, end = self.segments[first], self.segments[-1]
        drifted_rad = drift.radps * (end.moved_s - start.moved_s)
        about_rad = wrap_quarter(start.turn_rad + drifted_rad + direction_rad)
        self.axis = Axis(about_rad, start.turn_variance + ABOUT_RAD**2)
        self.turn_variance = self.crossed = before = start.turn_variance
        corrected_rad = 0.0
        for segment in self.segments[first:]:
            self.turn_variance += max(0.0, segment.turn_variance - before)
            before = segment.turn_variance
            then_rad = start.turn_rad + drift.radps * (segment.moved_s - start.moved_s)
            variance = self.turn_variance
            held = self._held(then_rad + corrected_rad, variance)
            corrected_rad = self._follow(segment, held, corrected_rad, variance)[0]
        return start.turn_rad + drifted_rad + corrected_rad, self.turn_variance

    def _align_variance(self, variance: float) -> None:
        """Carry changes of the heading variance made elsewhere into the joint distribution."""
        axis, was = self.axis, self.turn_variance
        if axis is not None and variance < was:
            left = variance / was
            reduction = self.crossed**2 / was * (1.0 - left)
            self.axis = Axis(axis.direction_rad, max(axis.variance - reduction, 1e-6))
            self.crossed *= left
        self.turn_variance = variance
