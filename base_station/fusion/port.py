"""What a fuser is: one unit's own path, with whatever else is known, as a place on the plan.

A fuser sees the unit's positions in the unit's own frame (NED about its start, heading of that
north unknown) and places in the incident frame.  It works in the unit's monotonic time, knows
no clock, and gives the same answers for the same calls.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import msgspec

from base_station.fusion.learnt.building import LearntBuilding
from base_station.site.floor_grid import FloorGrid
from base_station.site.storeys import Storey
from shared.messages import Position
from shared.quality import Quality


class PlaceFix(msgspec.Struct, frozen=True):
    """A satellite fix that passed the screening, in the incident frame."""

    t_mono_ns: int  # the unit's monotonic time at which it is valid
    north_m: float
    east_m: float
    down_m: float
    horizontal_std_m: float
    vertical_std_m: float | None  # None: a fix without height
    common_m2: float | None = None  # what all receivers err by, each axis, as far as it was learnt
    seen_m: tuple[float, float] | None = None  # north and east before that was taken off


class AirHeight(msgspec.Struct, frozen=True):
    """What a barometer tells, apart from a shift of its own."""

    t_mono_ns: int
    down_m: float
    referenced: bool  # the weather is taken out of it


class Bearing(msgspec.Struct, frozen=True):
    """What a compass tells; its error lasts."""

    turn_rad: float  # heading of the unit's own north, in the incident frame
    std_rad: float


class Start(msgspec.Struct, frozen=True):
    """Where the origin of the unit's own frame lies, and the heading of its north."""

    north_m: float
    east_m: float
    down_m: float
    heading_rad: float
    std_m: float
    heading_std_rad: float  # pi and above: unknown


class Present(msgspec.Struct, frozen=True):
    """Where a unit is now, as everything that is known of its past tells it.

    ``mean`` (5) and ``covariance`` (5, 5) of ``[north, east, c, s, w]``: ``c + i s`` is scale and
    turn of the own frame (see ``plane.horizontal``), ``w`` the rate in rad/s at which its heading
    drifts while the wearer moves.
    """

    mean: list[float]
    covariance: list[list[float]]
    down_shift_m: float = 0.0  # what is known of the height beside what was estimated
    down_std_m: float | None = None  # None: nothing


class FixVerdict(msgspec.Struct, frozen=True):
    accepted: bool
    reason: str = ""  # why not, for a person; the same words for the same cause
    faulty: bool = False  # it cannot be true: the receiver is wrong, or the site's place is


class Estimate(msgspec.Struct, frozen=True):
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
    height_assumed: bool = False  # nothing said how high the own frame begins: on the ground?
    assumed: bool = False  # nothing said where it lies: shown as if it were the incident frame


class Fuser(Protocol):
    """One unit's filter."""

    def start(self, start: Start) -> None:
        """Place the unit's own frame; whatever it walked since then is walked from there."""
        ...

    def settle(self, present: Present) -> None:
        """Go on from here: what was believed of place, turn and drift is replaced."""
        ...

    def consider(self, grid: FloorGrid | None) -> None:
        """What stands in the way, from now on; None: nothing is known of it.  Is not saved."""
        ...

    def advance(self, position: Position, away_s: float = 0.0) -> str:
        """Follow the unit's own path; says why where a position could not be followed.

        A position of another boot than the last begins a new frame where the unit has got to in
        ``away_s``, for which nothing was known of its path.
        """
        ...

    def feel(self, air: AirHeight) -> None:
        """The air pressure that came with the last position."""
        ...

    def face(self, bearing: Bearing) -> None:
        """What the unit's compass said with the last position; it is worth no more for being
        repeated.
        """
        ...

    def rest_on(self, storeys: Sequence[Storey]) -> None:
        """The wearer walks on the level, and these storeys are there."""
        ...

    def recognise(self, learnt: LearntBuilding) -> LearntBuilding:
        """Go by what everybody's paths have shown of the building, where the own path shows it
        too; gives what is known of it then.
        """
        ...

    def correct(self, fix: PlaceFix) -> FixVerdict: ...

    def reframe(self, turn_rad: float, north_m: float, east_m: float, down_m: float) -> None:
        """The incident frame was moved: turn everything clockwise, then shift it."""
        ...

    def estimate(self) -> Estimate | None:
        """None before anything is known."""
        ...

    def recall(self, position: Position) -> Estimate | None:
        """Where the wearer was at another position of the unit's own path, as it looks now; of the
        run of its program before this one, as it looked when that was over.  None where it is of
        neither.  Changes nothing.
        """
        ...

    def remember(self, position: Position) -> None:
        """An earlier position of the own path that came late: fixes of that time can be used."""
        ...

    def save(self) -> bytes:
        """All of its state; restored, it goes on with the very same numbers."""
        ...


class FuserKind(Protocol):
    """A frozen dataclass whose fields are the fuser's parameters."""

    @property
    def name(self) -> str:
        """Short, lower case, with hyphens: it is in the log for ever."""
        ...

    def new(self) -> Fuser: ...

    def restore(self, saved: bytes) -> Fuser: ...
