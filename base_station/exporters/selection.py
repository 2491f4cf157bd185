"""Selection of an incident's tracks: some units or people, and a window of time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import msgspec

from base_station.exporters.interface import IncidentTracks, LazyTracks, WornTrack
from base_station.storage.db.window import FOREVER_NS
from shared.coded_text import Term, coded
from shared.errors import UserError


@dataclass(frozen=True, slots=True)
class TrackSelection:
    """Selection; without names it contains everyone."""

    names: Sequence[str] = ()  # ids of units, or names of people or crews, in any case
    from_ns: int = 0
    until_ns: int = FOREVER_NS  # before this

    def of(self, incident: IncidentTracks) -> IncidentTracks:
        """Selected tracks.  Raises UserError for a name that is not in the incident, and if no
        point is left.
        """
        self._require_known(incident)
        chosen = LazyTracks(lambda: self._chosen(incident.tracks))
        if any(True for _ in incident.tracks) and not any(True for _ in chosen):
            raise UserError(
                coded(
                    "export-no-track",
                    "none of the selected people and units has a track in that time",
                )
            )
        return replace(incident, tracks=chosen)

    def _chosen(self, tracks: Iterable[WornTrack]) -> Iterator[WornTrack]:
        for track in tracks:
            if self._has(track) and (within := self._within(track)).points:
                yield within

    def _has(self, track: WornTrack) -> bool:
        return not self.names or bool(_names(track) & {name.casefold() for name in self.names})

    def _within(self, track: WornTrack) -> WornTrack:
        points = tuple(
            point for point in track.points if self.from_ns <= point.t_ns < self.until_ns
        )
        return msgspec.structs.replace(track, points=points)

    def _require_known(self, incident: IncidentTracks) -> None:
        if not self.names:  # all tracks are read once to list the people
            return
        known: set[str] = set()
        people: set[str] = set()
        for track in incident.tracks:
            known |= _names(track)
            people.add(track.title)
        unknown = [name for name in self.names if name.casefold() not in known]
        if unknown:
            raise UserError(
                coded(
                    "export-selection-unknown",
                    "'{name}' is no unit, person or crew with a track in this incident; there "
                    "are {known}",
                    name=unknown[0],
                    known=", ".join(sorted(people)) or Term("none", "none"),
                )
            )


def _names(track: WornTrack) -> set[str]:
    return {name.casefold() for name in (track.unit_id, track.person_name, track.crew) if name}
