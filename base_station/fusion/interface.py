"""Interface of fusers: filters that estimate one unit's place on the plan from its own path and
other measurements.

Positions come in the unit's own frame (NED about its start, unknown heading of that north), places
in the incident frame. A fuser works in the unit's monotonic time, reads no clock, and returns the
same for the same calls.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import msgspec

from base_station.fusion.building_model.building import LearntBuilding
from base_station.site.floor_grid import FloorGrid
from base_station.site.storeys import Storey
from shared.messages import Position
from shared.quality import Quality

MAX_FIX_DISTANCE_M = 50_000.0  # from the anchor


class PlaceFix(msgspec.Struct, frozen=True):
    """A satellite fix that passed the screening, in the incident frame."""

    t_mono_ns: int  # the unit's monotonic time at which it is valid
    north_m: float
    east_m: float
    down_m: float
    horizontal_std_m: float
    vertical_std_m: float | None  # None: a fix without height
    common_m2: float | None = None  # learnt common error of all receivers, each axis
    uncorrected_m: tuple[float, float] | None = None  # north and east before that was taken off


class BarometricHeight(msgspec.Struct, frozen=True, gc=False):
    """Height by a barometer, up to its bias."""

    t_mono_ns: int
    down_m: float
    referenced: bool  # without the weather


class CompassHeading(msgspec.Struct, frozen=True):
    """Heading by a compass; its error is constant over long times."""

    turn_rad: float  # heading of the unit's own north, in the incident frame
    std_rad: float


class Start(msgspec.Struct, frozen=True):
    """Start position: origin of the unit's own frame and heading of its north."""

    north_m: float
    east_m: float
    down_m: float
    heading_rad: float
    std_m: float
    heading_std_rad: float  # pi and above: unknown


class Posterior(msgspec.Struct, frozen=True):
    """State of a unit now, from all evidence of its past.

    ``mean`` (5) and ``covariance`` (5, 5) of ``[north, east, c, s, w]``: ``c + i s`` is scale and
    turn of the own frame (see ``horizontal.horizontal``), ``w`` the drift rate of its heading in
    rad/s while the wearer moves.
    """

    mean: list[float]
    covariance: list[list[float]]
    down_shift_m: float = 0.0  # evidence of the height beside the estimate
    down_std_m: float | None = None  # None: nothing


class FixVerdict(msgspec.Struct, frozen=True):
    accepted: bool
    reason: str = ""  # reason for a person; the same text for the same cause
    faulty: bool = False  # it cannot be true: the receiver is wrong, or the site's place is


class Estimate(msgspec.Struct, frozen=True, gc=False):
    """NED metres in the incident frame."""

    t_mono_ns: int  # the unit's time to which it belongs
    north_m: float
    east_m: float
    down_m: float
    std_north_m: float
    std_east_m: float
    std_down_m: float
    correlation_ne: float
    heading_rad: float  # of travel
    heading_std_rad: float  # pi and above: unknown
    quality: Quality
    quality_reason: str
    since_gps_s: float | None
    height_assumed: bool = False  # no evidence of the height of the own frame: on the ground?
    assumed: bool = False  # no evidence where it lies: shown as if it were the incident frame


class Fuser(Protocol):
    """One unit's filter."""

    def start(self, start: Start) -> None:
        """Set the origin of the own frame; the path walked since then begins there."""
        ...

    def set_posterior(self, posterior: Posterior) -> None:
        """Replace place, turn and drift of the state."""
        ...

    def set_map(self, grid: FloorGrid | None) -> None:
        """Set the walls to use; None: no plan. Not part of the saved state."""
        ...

    def predict(self, position: Position, outage_s: float = 0.0) -> str:
        """Predict the state along the own path; returns the reason where a position cannot be used.

        A position of another boot begins a new frame, at a place within the distance walked in
        ``outage_s`` without any path.
        """
        ...

    def update_barometer(self, air: BarometricHeight) -> None:
        """Update with the barometric height of the last position."""
        ...

    def update_heading(self, heading: CompassHeading) -> None:
        """Update with the compass heading of the last position; repeated readings add no
        information.
        """
        ...

    def constrain_to_floors(self, storeys: Sequence[Storey]) -> None:
        """Update with the fact that the wearer walks on the level on one of these storeys."""
        ...

    def match_building(self, learnt: LearntBuilding) -> LearntBuilding:
        """Match the path with the building model, and return the model with its new
        observations.
        """
        ...

    def update_gnss(self, fix: PlaceFix) -> FixVerdict: ...

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        """Move to another incident frame: turn everything clockwise, then shift it."""
        ...

    def estimate(self) -> Estimate | None:
        """Present estimate; None without any input."""
        ...

    def estimate_at(self, position: Position) -> Estimate | None:
        """Estimate at another position of the own path, from the present state; of the previous run
        of the unit's program, from its last state. None of any other run. Changes nothing.
        """
        ...

    def insert_late_position(self, position: Position) -> None:
        """Insert an earlier position of the own path that came late, so that fixes of that time can
        be used.
        """
        ...

    def save(self) -> bytes:
        """Serialised state; a restored fuser continues with equal numbers."""
        ...


class FuserKind(Protocol):
    """A frozen dataclass whose fields are the fuser's parameters."""

    @property
    def name(self) -> str:
        """Short, lower case, with hyphens: it is in the log for ever."""
        ...

    def new(self) -> Fuser: ...

    def restore(self, saved: bytes) -> Fuser: ...
