"""Replay of one incident of several that were open at once, without data of the others."""

from __future__ import annotations

import msgspec

from base_station.engine.ports import LiveSink, Trails
from base_station.views.wire import Delta, SiteView, Snapshot, UnitView


class IncidentSink:
    """A ``LiveSink`` that hands on the data of one incident.  A unit that leaves it is handed on
    once more, with its new incident, so that a console removes it.
    """

    def __init__(self, sink: LiveSink, incident_id: str) -> None:
        self._sink = sink
        self._incident_id = incident_id
        self._units: set[str] = set()  # in the incident now
        self._site_id = ""

    def reset(self, snapshot: Snapshot, trails: Trails) -> None:
        self._sink.reset(*self.of_incident(snapshot, trails))

    def delta(self, delta: Delta) -> None:
        before = set(self._units)
        for unit in delta.units:
            (self._units.add if self._is_member(unit) else self._units.discard)(unit.unit_id)
        shown = self._units | before
        beacons, external = delta.beacons, delta.external
        self._sink.delta(
            msgspec.structs.replace(
                delta,
                units=tuple(one for one in delta.units if one.unit_id in shown),
                alarms=tuple(one for one in delta.alarms if self._is_of(one.unit_id)),
                commands=tuple(
                    one
                    for one in delta.commands
                    if self._is_ordered(one.incident_id, [to.unit_id for to in one.units])
                ),
                trails={one: it for one, it in delta.trails.items() if one in self._units},
                pins=None
                if delta.pins is None
                else tuple(one for one in delta.pins if one.unit_id in self._units),
                beacons=None
                if beacons is None
                else tuple(one for one in beacons if one.site_id == self._site_id),
                external=None
                if external is None
                else tuple(one for one in external if one.site_id == self._site_id),
            )
        )

    def of_incident(self, snapshot: Snapshot, trails: Trails) -> tuple[Snapshot, Trails]:
        """The snapshot as it is of the incident alone; of an earlier version as it is."""
        incidents = [*snapshot.incidents, *([snapshot.incident] if snapshot.incident else [])]
        incident = next((one for one in incidents if one.incident_id == self._incident_id), None)
        self._units = {one.unit_id for one in snapshot.units if self._is_member(one)}
        shown_site_id = snapshot.incident.site_id if snapshot.incident else ""
        self._site_id = shown_site_id if incident is None else incident.site_id
        ground = next((one for one in snapshot.sites if one.site_id == self._site_id), None)
        return msgspec.structs.replace(
            snapshot if ground is None else _with_site(snapshot, ground),
            incident=incident or snapshot.incident,
            incidents=(),
            sites=(),
            units=tuple(one for one in snapshot.units if one.unit_id in self._units),
            alarms=tuple(one for one in snapshot.alarms if self._is_of(one.unit_id)),
            commands=tuple(
                one
                for one in snapshot.commands
                if self._is_ordered(one.incident_id, [to.unit_id for to in one.units])
            ),
            pins=tuple(one for one in snapshot.pins if one.unit_id in self._units),
            beacons=tuple(one for one in snapshot.beacons if one.site_id == self._site_id),
            external=tuple(one for one in snapshot.external if one.site_id == self._site_id),
        ), {one: it for one, it in trails.items() if one in self._units}

    def _is_member(self, unit: UnitView) -> bool:
        return unit.incident_id in (None, self._incident_id)

    def _is_of(self, unit_id: str) -> bool:
        return not unit_id or unit_id in self._units

    def _is_ordered(self, incident_id: str, unit_ids: list[str]) -> bool:
        return incident_id in ("", self._incident_id) and any(map(self._is_of, unit_ids))


def _with_site(snapshot: Snapshot, ground: SiteView) -> Snapshot:
    plan = None if bytes(ground.plan) == b"null" else ground.plan
    return msgspec.structs.replace(
        snapshot, plan=plan, anchor=ground.anchor, plan_placed=ground.plan_placed
    )
