"""Interface of an exporter, and the incident that it is given."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise

import msgspec

from base_station.storage.db.records import TrackSample
from base_station.views.answer import to_ms
from shared.clock import NS_PER_S
from shared.errors import UserError
from shared.geo import Anchor

# Somebody at rest leaves a point every 15 s; over a longer gap nobody knows the way.
LONGEST_STEP_NS = 20 * NS_PER_S
_SAME_PLACE_M = 1.0


class WornTrack(msgspec.Struct, frozen=True):
    """Where one unit was while one person wore it, by time."""

    unit_id: str
    person_name: str  # empty: nobody was assigned
    crew: str
    points: tuple[TrackSample, ...]  # NED metres in the incident frame

    @property
    def title(self) -> str:
        return f"{self.person_name} ({self.unit_id})" if self.person_name else self.unit_id

    @property
    def pieces(self) -> tuple[tuple[TrackSample, ...], ...]:
        """Each to be drawn as a line of its own: between two of them the way is not known."""
        return tuple(map(tuple, pieces_of(self.points)))


class IncidentTracks(msgspec.Struct, frozen=True):
    incident_id: str
    name: str
    anchor: Anchor | None
    tracks: tuple[WornTrack, ...]

    def named_as(self, description: str) -> IncidentTracks:
        """With what its trails are in its name."""
        return msgspec.structs.replace(self, name=f"{self.name}, {description}")

    def anchor_or_refuse(self) -> Anchor:
        """For formats that know only places on the Earth; UserError without an anchor."""
        if self.anchor is None:
            raise UserError(
                "the site has no place on the Earth, so this format cannot be written: set the "
                "anchor, or export as csv"
            )
        return self.anchor


def pieces_of(points: Sequence[TrackSample]) -> Sequence[Sequence[TrackSample]]:
    """Parts of a trail between which the way is not known."""
    breaks = [
        index
        for index, (before, after) in enumerate(pairwise(points), 1)
        if _is_unknown_between(before, after)
    ]
    ends = pairwise((0, *breaks, len(points)))
    return [points[begin:end] for begin, end in ends]


def _is_unknown_between(before: TrackSample, after: TrackSample) -> bool:
    if after.t_ns - before.t_ns <= LONGEST_STEP_NS:
        return False
    moved_m = math.hypot(after.north_m - before.north_m, after.east_m - before.east_m)
    return moved_m > _SAME_PLACE_M or after.floor != before.floor


def time_of(point: TrackSample) -> str:
    """ISO 8601 to the millisecond, which is that of the API."""
    at = datetime.fromtimestamp(to_ms(point.t_ns) / 1000, UTC)
    return f"{at:%Y-%m-%dT%H:%M:%S}.{at.microsecond // 1000:03}Z"


@dataclass(frozen=True, slots=True)
class Exporter:
    """``export`` is pure: the same incident gives the same bytes."""

    name: str  # as in the address
    suffix: str  # of the file
    media_type: str
    needs_anchor: bool
    export: Callable[[IncidentTracks], bytes]
