"""Interface of trackers: inertial samples in, estimates of the path out.

The navigation frame is NED with its origin at the first sample and, until something better is
known, an arbitrary but constant heading of "north".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from edge.body_places import FOOT, LEFT_FOOT, RIGHT_FOOT
from edge.samples import Floats, ImuBatch, Nanoseconds, SensorDescription
from shared.earth_field import EarthField
from shared.path_noise import PathNoise
from shared.quality import Quality, Reason

__all__ = [
    "FOOT",
    "LEFT_FOOT",
    "MOST_LAG_S",
    "RIGHT_FOOT",
    "BodyDimensions",
    "LearnsSteps",
    "MultiSensorTracker",
    "MultiSensorTrackerEntry",
    "Quality",
    "Reason",
    "ScaledByPerson",
    "StepScale",
    "TrackBatch",
    "Tracker",
    "TrackerEntry",
    "WornSensor",
]

MOST_LAG_S = 0.4  # by which samples of one sensor of a person may come behind those of another
# Legs of adults in shoes: 0.53 of the height is usual (Drillis and Contini 1966).
_LEG_M = (0.6, 1.3)
_LEG_OF_HEIGHT = (0.43, 0.63)


@dataclass(frozen=True, slots=True, eq=False)
class TrackBatch:
    """Estimates for consecutive samples, one row a sample, possibly none.

    A tracker may hold samples back for at most one second (fixed lag); the
    rows say their own time, in order, each sample's row exactly once.
    """

    t_ns: Nanoseconds  # (n,) the sample's own time
    position_n_m: Floats  # (n, 3) north, east, down
    velocity_n_mps: Floats  # (n, 3)
    quaternion_nb: Floats  # (n, 4) Hamilton w, x, y, z; takes sensor axes to navigation axes
    position_cov_m2: Floats  # (n, 3, 3)
    heading_std_rad: Floats  # (n,)
    stationary: NDArray[np.bool_]  # (n,) the foot stands still
    # What was put right of the walk behind since the start, and is in the columns above: by how
    # much the position moved without a step, and the heading turned where the walk did not follow.
    past_shift_n_m: Floats  # (n, 2) north, east
    past_turn_rad: Floats  # (n,) clockwise
    distance_m: Floats  # (n,) horizontal path length since the start, stance to stance
    steps: NDArray[np.int64]  # (n,) strides of this foot counted since the start
    quality: NDArray[np.uint8]  # (n,) Quality
    reasons: NDArray[np.uint32]  # (n,) Reason bits
    magnetic_north_rad: Floats  # (n,) where it lies in the frame, clockwise from the frame's north
    magnetic_north_std_rad: Floats  # (n,) infinite where the tracker does not know it

    def __len__(self) -> int:
        return len(self.t_ns)

    def part(self, rows: NDArray[np.intp]) -> TrackBatch:
        return TrackBatch(*(getattr(self, column.name)[rows] for column in fields(self)))


class Tracker(Protocol):
    """``push`` in any batching gives the same rows to the last bit."""

    @property
    def path_noise(self) -> PathNoise | None:
        """Process noise of the rows that ``push`` returned last; None: a foot's, which those who
        use the rows take for usual.
        """
        ...

    def push(self, batch: ImuBatch) -> TrackBatch:
        """Take samples; return the rows that have become final."""
        ...

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """Set the earth's field around here; holds for samples from ``t_ns`` on, which are still to
        be pushed.
        """
        ...

    def finish(self) -> TrackBatch:
        """Return the rows still held back; the tracker is used up."""
        ...


@dataclass(frozen=True, slots=True)
class TrackerEntry:
    """Line of ``TRACKERS``."""

    name: str
    summary: str
    make: Callable[[SensorDescription], Tracker]
    worn_on: tuple[str, ...] = (FOOT,)  # parts of the body, the one it is meant for first
    by_compass: bool = False  # keeps its heading by the magnetometer


@dataclass(frozen=True, slots=True)
class WornSensor:
    """One of the sensors of a person."""

    description: SensorDescription
    place: str  # part of the body


@dataclass(frozen=True, slots=True)
class StepScale:
    """Length of steps by that which a tracker takes them for, and its standard deviation."""

    factor: float
    std: float


@runtime_checkable
class ScaledByPerson(Protocol):
    """Tracker by steps whose lengths are known better of a person than of people."""

    def set_step_scale(self, scale: StepScale) -> None:
        """Start with this scale; before the first samples."""
        ...


@runtime_checkable
class LearnsSteps(Protocol):
    """Tracker of a person whose walk shows how long the person's steps are."""

    @property
    def scaled_place(self) -> str | None:
        """Place of the sensor whose steps make all of the path; None: there is none such."""
        ...

    @property
    def start_scales(self) -> Mapping[str, StepScale | None]:
        """Scales with which it has started, by places of those sensors whose steps it counts; None:
        that of people in the mean.
        """
        ...

    @property
    def walked_step_scales(self) -> Mapping[str, StepScale]:
        """Scales that the person's other sensors have shown in this walk, by place."""
        ...


@dataclass(frozen=True, slots=True)
class BodyDimensions:
    """Measures of a person that are known in advance; ``None``: unknown."""

    height_m: float | None = None
    leg_length_m: float | None = None  # hip joint to sole, in shoes
    step_scales: Mapping[str, StepScale] = field(default_factory=dict)  # by place of the sensor

    @property
    def is_leg_implausible(self) -> bool:
        """True for a leg length that no adult has, or none of that height."""
        if self.leg_length_m is None:
            return False
        if not _LEG_M[0] <= self.leg_length_m <= _LEG_M[1]:
            return True
        if self.height_m is None:
            return False
        return not _LEG_OF_HEIGHT[0] <= self.leg_length_m / self.height_m <= _LEG_OF_HEIGHT[1]


class MultiSensorTracker(Protocol):
    """Tracker of one person by several sensors, which are identified by name.

    The times of all sensors are those of one clock.  The rows are those of the person, one for each
    sample of the leading sensor, or of another while the leading one is silent.  Any batching and
    interleaving gives the same rows to the last bit, as long as no sensor's samples are pushed more
    than ``MOST_LAG_S`` behind another's.  A sensor that is silent for longer is gone until it comes
    back, and the rows go on with what the others show.
    """

    @property
    def path_noise(self) -> PathNoise | None:
        """Process noise of the rows; see ``Tracker``."""
        ...

    def push(self, sensor: str, batch: ImuBatch) -> TrackBatch:
        """Take samples of one sensor; return the rows that have become final."""
        ...

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        """Set the earth's field around here; see ``Tracker``."""
        ...

    def finish(self) -> TrackBatch:
        """Return the rows still held back; the tracker is used up."""
        ...


@dataclass(frozen=True, slots=True)
class MultiSensorTrackerEntry:
    """Line of ``MULTI_SENSOR_TRACKERS``."""

    name: str
    summary: str
    make: Callable[[Mapping[str, WornSensor], BodyDimensions], MultiSensorTracker]
    # The sensors that it needs, the leading one first: for each the places that will do.
    places: tuple[tuple[str, ...], ...]
