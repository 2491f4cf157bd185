"""Interface of an exporter, and the incident that it receives."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from itertools import chain, pairwise

import msgspec

from base_station.storage.db.records import TrackSample
from base_station.views.answer import to_ms
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import UserError
from shared.geo import Anchor

# A wearer at rest leaves a point every 15 s; over a longer gap the way is unknown.
LONGEST_STEP_NS = 20 * NS_PER_S
_SAME_PLACE_M = 1.0
_BLOCK_CHARACTERS = 1 << 16


class WornTrack(msgspec.Struct, frozen=True):
    """Track of one unit while one person wore it, in time order."""

    unit_id: str
    person_name: str  # empty: no person was assigned
    crew: str
    points: tuple[TrackSample, ...]  # NED metres in the incident frame

    @property
    def title(self) -> str:
        return f"{self.person_name} ({self.unit_id})" if self.person_name else self.unit_id

    @property
    def pieces(self) -> tuple[tuple[TrackSample, ...], ...]:
        """Parts that are drawn as lines of their own: between two of them the way is not known."""
        return tuple(map(tuple, pieces_of(self.points)))


class LazyTracks(Iterable[WornTrack]):
    """Tracks that are made again at each iteration: those of all units together would be too
    large.
    """

    def __init__(self, make: Callable[[], Iterator[WornTrack]]) -> None:
        self._make = make

    def __iter__(self) -> Iterator[WornTrack]:
        return self._make()


class TrackCount(Iterable[WornTrack]):
    """The same tracks, which are counted at the last iteration."""

    def __init__(self, of: Iterable[WornTrack]) -> None:
        self._of = of
        self.tracks = self.points = 0

    def __iter__(self) -> Iterator[WornTrack]:
        self.tracks = self.points = 0
        for track in self._of:
            self.tracks += 1
            self.points += len(track.points)
            yield track


@dataclass(frozen=True, slots=True)
class IncidentTracks:
    incident_id: str
    name: str
    anchor: Anchor | None
    tracks: Iterable[WornTrack]  # may be gone through more than once
    ground_down_m: float | None = None  # down of the ground floor; None: no plan lists it
    description: str = ""  # of the dispatch; empty: there was none

    def named_as(self, description: str) -> IncidentTracks:
        """The same tracks, with a description added to the name."""
        return replace(self, name=f"{self.name}, {description}")

    def anchor_or_refuse(self) -> Anchor:
        """Anchor for formats that know only positions on the Earth; UserError if there is none."""
        if self.anchor is None:
            raise UserError(
                coded(
                    "export-no-anchor",
                    "the site has no place on the Earth, so this format cannot be written: set "
                    "the anchor, or export as csv",
                )
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
    """Time in ISO 8601 to the millisecond, as in the API."""
    at = datetime.fromtimestamp(to_ms(point.t_ns) / 1000, UTC)
    return f"{at:%Y-%m-%dT%H:%M:%S}.{at.microsecond // 1000:03}Z"


def in_blocks(texts: Iterable[str]) -> Iterator[bytes]:
    """The text as UTF-8, in blocks that are large enough to be written one by one."""
    block: list[str] = []
    size = 0
    for text in texts:
        block.append(text)
        size += len(text)
        if size >= _BLOCK_CHARACTERS:
            yield "".join(block).encode()
            block.clear()
            size = 0
    if block:
        yield "".join(block).encode()


@dataclass(frozen=True, slots=True)
class Exporter:
    """Format of tracks.  ``export`` is pure: the same incident gives the same bytes.  It holds no
    more in memory than one track needs, and raises UserError before it yields the first bytes.
    """

    name: str  # as in the address
    suffix: str  # of the file
    media_type: str
    needs_anchor: bool
    export: Callable[[IncidentTracks], Iterator[bytes]]
    is_compressed: bool = False  # so that gzip makes it no smaller

    def begun(self, incident: IncidentTracks) -> Iterator[bytes]:
        """The same bytes, of which the first are already made, so that every refusal occurs
        here.
        """
        content = self.export(incident)
        first = next(content, b"")
        return chain((first,), content)
