"""Collects an incident for the exporters from the store."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from base_station.dispatch.description import description
from base_station.exporters.interface import IncidentTracks, LazyTracks, WornTrack
from base_station.site.plan import salvage_plan
from base_station.site.storeys import storey_of
from base_station.storage.db.known_people import PersonLookup, shown_wearer
from base_station.storage.db.models import Assignment, IncidentRow
from base_station.storage.db.records import Records, TrackSample
from base_station.storage.db.roster import Roster
from base_station.storage.db.window import FOREVER_NS, Window


def incident_tracks(
    records: Records,
    roster: Roster,
    incident: IncidentRow,
    trails: Mapping[str, Sequence[TrackSample]] | None = None,
) -> IncidentTracks:
    """All tracks of an incident, split where a unit changed its wearer.  ``trails`` (by unit)
    replace those that were shown at the time.
    """
    window = Window(incident.opened_ns, incident.closed_ns or FOREVER_NS)
    number = incident.dispatch_number
    dispatch = records.dispatch(number) if number else None
    by_unit = records.tracks_of(incident) if trails is None else trails
    assignments: dict[str, list[Assignment]] = {unit_id: [] for unit_id in by_unit}
    for one in roster.assignments(window.from_ns, window.until_ns):
        assignments.setdefault(one.unit_id, []).append(one)

    def tracks() -> Iterator[WornTrack]:
        for unit_id in by_unit:
            yield from _split(roster.known, unit_id, by_unit[unit_id], assignments[unit_id])

    return IncidentTracks(
        incident_id=incident.incident_id,
        name=roster.shown(incident.name),
        anchor=records.anchor(window.until_ns, incident.site_id),
        tracks=LazyTracks(tracks),
        ground_down_m=_ground_down_m(records.plan(window.until_ns, incident.site_id)),
        description="" if dispatch is None else roster.shown(description(dispatch)),
    )


def _ground_down_m(geojson: bytes | None) -> float | None:
    """Height of the plan's ground floor, which is at the ground outside."""
    storeys = () if geojson is None else salvage_plan(geojson).storeys
    ground = storey_of(storeys, 0)
    return None if ground is None else ground.down_m


def _split(
    people: PersonLookup,
    unit_id: str,
    points: Sequence[TrackSample],
    assignments: Sequence[Assignment],
) -> Iterable[WornTrack]:
    """Consecutive points with the same wearer form one track."""
    run: list[TrackSample] = []
    wearer = _Wearer()
    for point in points:
        now = _wearer(people, _assignment_at(point.t_ns, assignments))
        if run and now != wearer:
            yield WornTrack(unit_id, wearer.name, wearer.crew, tuple(run))
            run = []
        wearer = now
        run.append(point)
    if run:
        yield WornTrack(unit_id, wearer.name, wearer.crew, tuple(run))


class _Wearer(NamedTuple):
    """Wearer of a unit.  A person who is assigned again, as with a new photo, is the same
    wearer.
    """

    person_id: str = ""  # empty: not worn
    name: str = ""
    crew: str = ""


def _wearer(people: PersonLookup, worn: Assignment | None) -> _Wearer:
    if worn is None:
        return _Wearer()
    shown = shown_wearer(worn, people)
    return _Wearer(worn.person_id, shown.name, shown.crew)


def _assignment_at(t_ns: int, assignments: Sequence[Assignment]) -> Assignment | None:
    for one in reversed(assignments):
        if one.from_ns <= t_ns and (one.until_ns is None or t_ns < one.until_ns):
            return one
    return None
