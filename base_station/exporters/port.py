"""What an exporter gets, and what it is."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime

import msgspec

from base_station.db.records import TrackSample
from base_station.views.answer import to_ms
from shared.errors import UserError
from shared.geo import Anchor

_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


class WornTrack(msgspec.Struct, frozen=True):
    """Where one unit was while one person wore it, by time."""

    unit_id: str
    person_name: str  # empty: nobody was assigned
    crew: str
    points: tuple[TrackSample, ...]  # NED metres in the incident frame

    @property
    def title(self) -> str:
        return f"{self.person_name} ({self.unit_id})" if self.person_name else self.unit_id


class IncidentTracks(msgspec.Struct, frozen=True):
    incident_id: str
    name: str
    anchor: Anchor | None
    tracks: tuple[WornTrack, ...]

    def anchor_or_refuse(self) -> Anchor:
        """For formats that know only places on the Earth; UserError without an anchor."""
        if self.anchor is None:
            raise UserError(
                "the site has no place on the Earth, so this format cannot be written: set the "
                "anchor, or export as csv"
            )
        return self.anchor


def time_of(point: TrackSample) -> str:
    """ISO 8601 to the millisecond, which is that of the API."""
    at = datetime.fromtimestamp(to_ms(point.t_ns) / 1000, UTC)
    return f"{at:%Y-%m-%dT%H:%M:%S}.{at.microsecond // 1000:03}Z"


def in_xml(text: str) -> str:
    """With a mark for each character that XML has no place for: old logs have names with such."""
    return _NOT_IN_XML.sub("\ufffd", text)


@dataclass(frozen=True, slots=True)
class Exporter:
    """``export`` is pure: the same incident gives the same bytes."""

    name: str  # as in the address
    suffix: str  # of the file
    media_type: str
    needs_anchor: bool
    export: Callable[[IncidentTracks], bytes]
