"""People of an incident for its report: who wore which unit when, and where they went."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence

import msgspec

from base_station.report.contents import Interval, PersonEntry, WornTime
from base_station.report.log_facts import LogFacts
from base_station.report.trail import measure
from base_station.site.plan import Plan
from base_station.storage.db.members import Members
from base_station.storage.db.models import Assignment
from base_station.storage.db.records import Records, TrackSample
from base_station.storage.db.roster import Roster
from base_station.storage.db.window import Window


class IncidentPeople:
    """Wearers of the units of an incident, and their entries in the report."""

    def __init__(
        self,
        records: Records,
        roster: Roster,
        members: Members,
        assignments: Sequence[Assignment],
        during: Interval,
        window: Window,
    ) -> None:
        """``window``: span of the positions that are read; ``during``: span that the report
        describes.
        """
        self._records = records
        self._roster = roster
        self._members = members
        self._during = during
        self._window = window
        self.wearings = self._wearings(assignments)

    def name_at(self, unit_id: str, t_ns: int) -> str:
        """Return the name of the wearer at a time with the unit's id; the id alone without one."""
        for one in self.wearings.get(unit_id, ()):
            if one.name and one.during.from_ns <= t_ns <= one.during.until_ns:
                return f"{one.name} ({unit_id})"
        return unit_id

    def entries(
        self, plan: Plan | None, facts: LogFacts, on_progress: Callable[[float], None]
    ) -> tuple[PersonEntry, ...]:
        """Return the entries of all wearers, by crew and name."""
        found = []
        for done, (unit_id, worn) in enumerate(self.wearings.items(), 1):
            points = self._records.track(unit_id, self._window)
            for row, wearing in enumerate(worn):
                found.append(self._person(row, wearing, _part(points, wearing.during), plan, facts))
            on_progress(done / len(self.wearings))
        found.sort(key=lambda one: (one.wearing.crew, one.wearing.name, one.wearing.unit_id))
        return tuple(
            msgspec.structs.replace(one, number=number) for number, one in enumerate(found, 1)
        )

    def _wearings(self, assignments: Sequence[Assignment]) -> Mapping[str, Sequence[WornTime]]:
        """Wearings by unit, oldest first; a unit that was not worn has one without a name."""
        found: dict[str, list[WornTime]] = {}
        last_person: dict[str, str] = {}
        for one in assignments:
            until_ns = self._during.until_ns if one.until_ns is None else one.until_ns
            for during in self._present(one.unit_id, Interval(one.from_ns, until_ns)):
                known, of_unit = self._roster.wearer(one), found.setdefault(one.unit_id, [])
                is_same = last_person.get(one.unit_id) == one.person_id
                if of_unit and is_same and of_unit[-1].during.until_ns == during.from_ns:
                    during = Interval(of_unit.pop().during.from_ns, during.until_ns)  # noqa: PLW2901
                last_person[one.unit_id] = one.person_id
                of_unit.append(WornTime(one.unit_id, known.name, known.crew, known.role, during))
        for unit_id in self._records.track_units(self._window):
            if unit_id not in found:
                present = self._present(unit_id, self._during)
                found[unit_id] = [WornTime(unit_id, "", "", "", during) for during in present]
        return {unit_id: worn for unit_id, worn in sorted(found.items()) if worn}

    def _present(self, unit_id: str, worn: Interval) -> list[Interval]:
        """Parts of a span in which the unit was in the incident."""
        windows = self._members.of(unit_id)
        parts = [Interval(one.from_ns, one.until_ns).within(worn) for one in windows]
        return [part for one in parts if one and (part := one.within(self._during))]

    def _person(
        self,
        row: int,
        wearing: WornTime,
        points: Sequence[TrackSample],
        plan: Plan | None,
        facts: LogFacts,
    ) -> PersonEntry:
        unit = facts.units[wearing.unit_id]
        gaps = [gap.within(wearing.during) for gap in unit.radio_gaps]
        radio_gaps = tuple(gap for gap in gaps if gap is not None)
        figures = measure(points, plan, radio_gaps)
        return PersonEntry(
            number=0,
            wearing=wearing,
            positions=len(points),
            distance_m=figures.distance_m,
            inside_s=figures.inside_s,
            floors=figures.floors,
            hottest=unit.hottest.get(row),
            dose=unit.doses.get(row, 0.0),
            radio_gaps=radio_gaps,
            trails=figures.trails,
            begin=_place(points[0]) if points else None,
            end=_place(points[-1]) if points else None,
        )


def _part(points: Sequence[TrackSample], during: Interval) -> Sequence[TrackSample]:
    begin = bisect_right(points, during.from_ns - 1, key=lambda one: one.t_ns)
    end = bisect_right(points, during.until_ns, key=lambda one: one.t_ns)
    return points[begin:end]


def _place(point: TrackSample) -> tuple[int | None, float, float]:
    return point.floor, point.east_m, point.north_m
