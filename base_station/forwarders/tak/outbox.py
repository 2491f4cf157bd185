"""Outbox of one connection: the next events to send, newest position of each person, alerts first.

Events are made when they are sent and not before, so that a connection that was away for an hour
begins with the present positions.  Pure: times are given.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from base_station.forwarders.mailbox import Changes
from base_station.forwarders.tak.cot import (
    CotEvents,
    GeodeticPlace,
    GroundMotion,
    motion_between,
    place_of,
)
from base_station.forwarders.tak.emergencies import Emergencies, EmergencyAlert
from base_station.views.wire import AnchorView, PositionView, Snapshot, UnitView
from shared.clock import NS_PER_S
from shared.coded_text import coded

_LIVE = "live"
_NOT_LIVE_EVERY_NS = 10 * NS_PER_S  # without a link only the uncertainty grows
_UNPLACED_NS = NS_PER_S // 5  # then it is looked again whether an emergency has a place
_WAY_EVERY_NS = 15 * NS_PER_S
_WAY_PLACES = 60
_WAYS_AT_ONCE = 3
_WAY_STEP_M = 2.0
_METRES_PER_DEG = 111_195.0
_NO_PLACE = coded(
    "tak-no-place", "nothing is sent, as the site has no place on the Earth: set the anchor"
)
_NO_INCIDENT = coded("tak-no-incident", "people are sent while an incident is open")
_SOONEST_NS = NS_PER_S // 50


@dataclass(slots=True)
class _Person:
    """Events of a unit's wearer: those sent, and those still to be sent."""

    unit: UnitView
    is_waiting: bool = True
    sent_ns: int | None = None  # monotonic
    free_ns: int = 0  # monotonic, when the rate allows the next; one may be sent ahead of that
    sent_link: str = ""
    sent_place: tuple[int, GeodeticPlace] | None = None  # with the time of the position
    way: deque[GeodeticPlace] = field(default_factory=lambda: deque(maxlen=_WAY_PLACES))
    way_is_new: bool = False
    way_sent_ns: int = -_WAY_EVERY_NS


class TakOutbox:
    """``apply`` changes, then send the events of ``due``."""

    def __init__(self, events: CotEvents, every_s: float, *, breadcrumbs: bool) -> None:
        self._events = events
        self._every_ns = round(every_s * NS_PER_S)
        self._breadcrumbs = breadcrumbs
        self._people: dict[str, _Person] = {}
        self._emergencies = Emergencies()
        self._incident_is_open = False
        self.anchor: AnchorView | None = None  # of the site that is shown first
        self._anchors: dict[str, AnchorView | None] = {}  # of other open incidents, by id

    def apply(self, changes: Changes, now_ms: int) -> None:
        picture = changes.picture
        if picture is not None:
            self.anchor, self._anchors = picture.anchor, _anchors_by_incident(picture)
            incident = picture.incident
            self._incident_is_open = incident is not None and incident.closed_ms is None
            present = {unit.unit_id for unit in picture.units}
            self._people = {one: person for one, person in self._people.items() if one in present}
            for unit in picture.units:
                self._note(unit)
            self._emergencies.use_picture(picture.alarms, now_ms)
        for unit in changes.units.values():
            self._note(unit)
        for alarm in changes.alarms.values():
            self._emergencies.note(alarm)

    def _note(self, unit: UnitView) -> None:
        person = self._people.get(unit.unit_id)
        if person is None:
            self._people[unit.unit_id] = _Person(unit)
        else:
            person.unit, person.is_waiting = unit, True

    def begin_connection(self) -> None:
        """Make everything due: the other end has received nothing of it."""
        for person in self._people.values():
            person.is_waiting, person.sent_ns, person.sent_link = True, None, ""
            person.free_ns = 0
            person.way_sent_ns, person.way_is_new = -_WAY_EVERY_NS, len(person.way) > 1
        self._emergencies.repeat_all()

    def due(self, now_ns: int, now_ms: int) -> Iterator[bytes]:
        """Events to send now; they count as sent."""
        for alert in self._emergencies.due(now_ns):
            event = self._alert(alert, now_ms)
            if event is None:
                alert.due_ns = now_ns + _UNPLACED_NS
            else:
                self._emergencies.note_sent(alert, now_ns)
                yield event
        if not self._incident_is_open:
            return
        waiting = [one for one in self._people.values() if one.is_waiting]
        # Longest waiting first: where the other end is slow, everybody has a turn.
        for person in sorted(waiting, key=self._due_ns):
            if now_ns < self._due_ns(person):
                break
            event = self._position(person, now_ns)
            if event is not None:
                yield event
        if self._breadcrumbs:
            yield from self._ways(now_ns)

    def next_due_ns(self, now_ns: int) -> int:
        """Monotonic time of the next event, where nothing changes before."""
        people = self._people.values() if self._incident_is_open else ()
        times = [self._due_ns(one) for one in people if one.is_waiting]
        alert_ns = self._emergencies.next_due_ns
        if alert_ns is not None:
            times.append(alert_ns)
        return max(min(times, default=now_ns + NS_PER_S), now_ns + _SOONEST_NS)

    def _due_ns(self, person: _Person) -> int:
        if person.sent_ns is None or person.unit.link != person.sent_link:
            return 0
        if person.unit.link != _LIVE:
            return person.sent_ns + _NOT_LIVE_EVERY_NS
        return person.free_ns - self._every_ns

    def _alert(self, alert: EmergencyAlert, now_ms: int) -> bytes | None:
        placed = self._placed(alert.unit_id)
        if placed is None:
            return None
        if alert.is_open:
            return self._events.emergency(*placed, alert.rules, now_ms)
        return self._events.emergency_cancelled(*placed, now_ms)

    def _placed(self, unit_id: str) -> tuple[UnitView, PositionView, GeodeticPlace] | None:
        person = self._people.get(unit_id)
        if person is None or person.unit.position is None:
            return None
        place = place_of(person.unit.position, self._anchor_of(person.unit))
        return None if place is None else (person.unit, person.unit.position, place)

    def _anchor_of(self, unit: UnitView) -> AnchorView | None:
        return self._anchors.get(unit.incident_id or "", self.anchor)

    def _position(self, person: _Person, now_ns: int) -> bytes | None:
        """None: of a unit that is not ours, was switched off or has no place nothing is sent."""
        unit, person.is_waiting = person.unit, False
        placed = self._placed(unit.unit_id)
        if placed is None or not unit.registered or unit.switched_off:
            return None
        _, position, place = placed
        person.sent_ns, person.sent_link = now_ns, unit.link
        person.free_ns = max(person.free_ns, now_ns) + self._every_ns
        motion = GroundMotion(0.0, 0.0)
        anchor = self._anchor_of(unit)
        if anchor is not None and unit.link == _LIVE:
            rotation_rad = anchor.plan_rotation_rad
            motion = motion_between(person.sent_place, position, place, rotation_rad)
        if person.sent_place is None or position.t_ms > person.sent_place[0]:
            person.sent_place = position.t_ms, place
            self._extend_way(person, place)
        return self._events.person(unit, position, place, motion)

    def _extend_way(self, person: _Person, place: GeodeticPlace) -> None:
        if not person.way or _apart_m(person.way[-1], place) >= _WAY_STEP_M:
            person.way.append(place)
            person.way_is_new = len(person.way) > 1

    def _ways(self, now_ns: int) -> Iterator[bytes]:
        """A few at a time: a way is as long as ten positions, which would wait behind it."""
        due = [
            person
            for person in self._people.values()
            if person.way_is_new and now_ns >= person.way_sent_ns + _WAY_EVERY_NS
        ]
        for person in sorted(due, key=lambda one: one.way_sent_ns)[:_WAYS_AT_ONCE]:
            position = person.unit.position
            if position is not None:
                person.way_sent_ns, person.way_is_new = now_ns, False
                yield self._events.way(person.unit, position, tuple(person.way))

    @property
    def hint(self) -> str:
        """Reason why less is sent than a user may expect; empty: none."""
        if self.anchor is None and not any(self._anchors.values()):
            return _NO_PLACE
        unplaced = [one for one in self._emergencies.open_units if self._placed(one) is None]
        if unplaced:
            return coded(
                "tak-emergency-unplaced",
                "the emergency of {units} cannot be shown: its place is unknown",
                units=", ".join(unplaced),
            )
        return "" if self._incident_is_open else _NO_INCIDENT


def _anchors_by_incident(picture: Snapshot) -> dict[str, AnchorView | None]:
    """Anchors of open incidents on other sites than the one that is shown first; of no incident,
    that of the station's own site where another is shown first.
    """
    sites = {site.site_id: site.anchor for site in picture.sites}
    incidents = {one.incident_id: one.site_id for one in picture.incidents} | {"": ""}
    return {one: sites[site_id] for one, site_id in incidents.items() if site_id in sites}


def _apart_m(one: GeodeticPlace, other: GeodeticPlace) -> float:
    """Distance along the meridian or the parallel, whichever is longer; near enough for a step."""
    return _METRES_PER_DEG * max(abs(one.lat_deg - other.lat_deg), abs(one.lon_deg - other.lon_deg))
