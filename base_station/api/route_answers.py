"""Answers about ways to a member: the nearest rescuers, and their routes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from base_station.api.problems import Problem
from base_station.api.route_finder import NEAREST, place_of, std_m_of
from base_station.api.services import Services
from base_station.core.alarms.interface import EMERGENCY
from base_station.core.alarms.missed_check_in import MissedCheckIn
from base_station.routing.interface import Route, Waypoint
from base_station.routing.legs import RouteLeg, Turn, legs_of
from base_station.routing.words import line_text, route_text
from base_station.site.max_travel import RADII_95
from base_station.views.answer import Answer
from base_station.views.wire import PositionView, Snapshot, UnitView
from shared.coded_text import coded

_MISSED_CHECK_IN = MissedCheckIn().name  # a member without an answer is not down yet
HEADING_KNOWN_RAD = 0.8  # standard deviation up to which left and right mean something
NEXT_LEGS = 2  # that are sent to a unit at once


class RoutePlace(Answer, frozen=True):
    """A corner of a route."""

    north_m: float
    east_m: float
    floor: int | None


class RouteLegAnswer(Answer, frozen=True):
    """Leg of a route."""

    turn: Turn | None
    bearing_rad: float
    distance_m: float
    floors: int


class RouteAnswer(Answer, frozen=True):
    """Route of one rescuer to the member, or the straight line if no route is known."""

    unit_id: str
    known: bool
    distance_m: float
    uncertainty_m: float
    crosses_walls: bool
    text: str
    next_text: str
    legs: tuple[RouteLegAnswer, ...]
    places: tuple[RoutePlace, ...]


def find_routes(station: Services, unit_id: str, rescuer_id: str | None) -> list[RouteAnswer]:
    """Routes of the nearest rescuers, or of the named one, to a unit.

    Problem 404 for an unknown unit, 409 for one without a position and for the member itself.
    """
    if rescuer_id == unit_id:
        raise Problem(
            409, coded("rescuer-is-member", "The rescuer is the member: name another rescuer.")
        )

    def may_go(snapshot: Snapshot) -> Sequence[str]:
        return rescuers(snapshot, unit_id) if rescuer_id is None else (rescuer_id,)

    picture, known = station.route_finder.routes(station.picture_with_trails, unit_id, may_go)
    units = {unit.unit_id: unit for unit in picture.units}
    member = _position(units, unit_id)
    if rescuer_id is not None:
        _position(units, rescuer_id)
    return _answers(units, member, known, may_go(picture))[:NEAREST]


def _position(units: Mapping[str, UnitView], unit_id: str) -> PositionView:
    if unit_id not in units:
        raise Problem(404, coded("unit-unknown", "There is no such unit."))
    position = units[unit_id].position
    if position is None:
        raise Problem(
            409,
            coded(
                "unit-without-position", "{unit} has no position: none was received.", unit=unit_id
            ),
        )
    return position


def rescuers(snapshot: Snapshot, unit_id: str) -> list[str]:
    """Ids of the units whose wearers can go: located, linked, and not in danger themselves."""
    in_danger = {
        alarm.unit_id
        for alarm in snapshot.alarms
        if alarm.state != "resolved"
        and alarm.priority == EMERGENCY
        and alarm.rule != _MISSED_CHECK_IN
    }
    return [
        unit.unit_id
        for unit in snapshot.units
        if unit.unit_id not in {unit_id, *in_danger} and _can_go(unit)
    ]


def _can_go(unit: UnitView) -> bool:
    worn = unit.registered and unit.person is not None and not unit.switched_off
    return worn and unit.position is not None and unit.link in {"live", "stale"}


def _answers(
    units: Mapping[str, UnitView],
    member: PositionView,
    known: Mapping[str, Route],
    may_go: Iterable[str],
) -> list[RouteAnswer]:
    """Known routes first, then straight lines, each nearest first."""
    routes = [_route_answer(units[one], route) for one, route in known.items()]
    lines = [
        _line_answer(one, position, member)
        for one in may_go
        if one not in known and (position := units[one].position) is not None
    ]
    return [*routes, *sorted(lines, key=lambda line: line.distance_m)]


def _route_answer(unit: UnitView, route: Route) -> RouteAnswer:
    position = unit.position
    is_facing = position is not None and position.heading_std_rad < HEADING_KNOWN_RAD
    legs = legs_of(route.places, position.heading_rad if position and is_facing else None)
    return RouteAnswer(
        unit_id=unit.unit_id,
        known=True,
        distance_m=round(route.distance_m, 1),
        uncertainty_m=round(RADII_95 * route.std_m, 1),
        crosses_walls=route.crosses_walls,
        text=route_text(legs),
        next_text=route_text(legs[:NEXT_LEGS]),
        legs=tuple(map(_leg, legs)),
        places=tuple(map(_place, route.places)),
    )


def _line_answer(unit_id: str, rescuer: PositionView, member: PositionView) -> RouteAnswer:
    begin, end = place_of(rescuer), place_of(member)
    std_m = math.hypot(std_m_of(rescuer), std_m_of(member))
    text = line_text(begin, end)
    distance_m = math.hypot(end.north_m - begin.north_m, end.east_m - begin.east_m)
    return RouteAnswer(
        unit_id=unit_id,
        known=False,
        distance_m=round(distance_m, 1),
        uncertainty_m=round(RADII_95 * std_m, 1),
        crosses_walls=False,
        text=text,
        next_text=text,
        legs=(),
        places=(_place(begin), _place(end)),
    )


def _leg(leg: RouteLeg) -> RouteLegAnswer:
    return RouteLegAnswer(leg.turn, round(leg.bearing_rad, 3), round(leg.distance_m, 1), leg.floors)


def _place(place: Waypoint) -> RoutePlace:
    return RoutePlace(round(place.north_m, 2), round(place.east_m, 2), place.floor)
