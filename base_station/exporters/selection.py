"""Selection of an incident's tracks: some units or people, and a window of time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import msgspec

from base_station.exporters.interface import IncidentTracks, WornTrack
from base_station.storage.db.records import FOREVER_NS
from shared.errors import UserError


@dataclass(frozen=True, slots=True)
class TrackSelection:
    """Without names: everybody."""

    names: Sequence[str] = ()  # ids of units, or names of people or crews, in any case
    from_ns: int = 0
    until_ns: int = FOREVER_NS  # before this

    def of(self, incident: IncidentTracks) -> IncidentTracks:
        """Raises UserError for a name that nobody there has, and where no point is left."""
        self._require_known(incident)
        tracks = [self._within(track) for track in incident.tracks if self._has(track)]
        kept = tuple(track for track in tracks if track.points)
        if incident.tracks and not kept:
            raise UserError("nobody who is asked for has a track in that time")
        return msgspec.structs.replace(incident, tracks=kept)

    def _has(self, track: WornTrack) -> bool:
        return not self.names or bool(_names(track) & {name.casefold() for name in self.names})

    def _within(self, track: WornTrack) -> WornTrack:
        points = tuple(
            point for point in track.points if self.from_ns <= point.t_ns < self.until_ns
        )
        return msgspec.structs.replace(track, points=points)

    def _require_known(self, incident: IncidentTracks) -> None:
        known = {name for track in incident.tracks for name in _names(track)}
        unknown = [name for name in self.names if name.casefold() not in known]
        if unknown:
            people = sorted({track.title for track in incident.tracks})
            raise UserError(
                f"{unknown[0]!r} is no unit, person or crew with a track in this incident; there "
                f"are {', '.join(people) or 'none'}"
            )


def _names(track: WornTrack) -> set[str]:
    return {name.casefold() for name in (track.unit_id, track.person_name, track.crew) if name}
