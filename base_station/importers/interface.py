"""Interface of an importer, and the options that a person sets for a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from base_station.storage.imports import ImportedContent, ImportedPoint
from shared.clock import NS_PER_S
from shared.coded_text import coded, join_texts
from shared.errors import UserError

MOST_BYTES = 512 << 20  # of a file
MOST_POINTS = 1_000_000  # one a second at most: an hour of 250 people
MOST_TRACKS = 10_000


class ImportOptions(msgspec.Struct, frozen=True):
    """Corrections of the clock that made a file, from the person who imports it."""

    file_name: str  # as it was called where it comes from
    incident_id: str  # of the incident that it is brought into
    shift_s: float = 0.0  # added to its times
    utc_offset_h: float | None = None  # of a camera that does not state its time zone


@dataclass(frozen=True, slots=True)
class Importer:
    """Format of files.  ``read`` returns times as the file has them; the shift is added afterwards.
    It raises UserError if nothing in the file has a position and a time.
    """

    name: str  # of the format
    matches: Callable[[bytes], bool]  # by the first bytes of a file
    read: Callable[[Path, ImportOptions], ImportedContent]


def nothing_usable(damage: Sequence[str], reason: str) -> UserError:
    """Error for a file without usable content, with its damage, which may be the cause."""
    if not damage:
        return UserError(reason)
    return UserError(
        coded(
            "import-nothing-usable", "{damage}; {reason}", damage=join_texts(damage), reason=reason
        )
    )


class TrackPoints:
    """Points of one file while it is read: of a track one a second, in time order.

    ``add`` raises UserError beyond ``MOST_POINTS``.
    """

    def __init__(self) -> None:
        self._points: dict[int, ImportedPoint] = {}  # by second
        self._total = 0
        self._tracks = 0

    def add(self, point: ImportedPoint) -> None:
        if self._points.setdefault(point.t_ns // NS_PER_S, point) is point:
            self._total += 1
            if self._total > MOST_POINTS:
                raise UserError(
                    coded(
                        "import-points-too-many",
                        "it has more than {most} points, one a second: cut it by time",
                        most=MOST_POINTS,
                    )
                )

    def take(self) -> tuple[ImportedPoint, ...]:
        """Points of the track that has ended."""
        points = tuple(self._points[second] for second in sorted(self._points))
        self._points.clear()
        self._tracks += bool(points)
        if self._tracks > MOST_TRACKS:
            raise UserError(
                coded(
                    "import-tracks-too-many",
                    "it has more than {most} tracks: take a part of it",
                    most=MOST_TRACKS,
                )
            )
        return points
