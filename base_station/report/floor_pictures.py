"""Pictures of floors: the plan, and trails on it.  Line styles have the same meaning as colours."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from base_station.report import texts
from base_station.report.contents import FloorTrail, Line, PersonEntry
from base_station.report.markup import Markup, element
from base_station.report.style import END, GAP, NUMBER, ON_LINE, PAPER, SCALE, SMALL, TRAIL, WALL
from base_station.site.plan import Plan

# Okabe and Ito (2008), those that are dark enough on white: distinct for the colour-blind.
COLOURS = ("#000000", "#0072b2", "#d55e00", "#009e73", "#a3527d", "#7a5c00")
_WIDTH, _MOST_HEIGHT = 680.0, 440.0
_SMALL_WIDTH, _SMALL_HEIGHT = 230.0, 200.0
_MARGIN = 18.0
_LEAST_M = 10.0  # shown, however small the movement
_NUMBER_EVERY = 110.0  # along a trail, in the picture's units
_BESIDE_BEGIN = 12.0  # the circle of the first position stays free
_STAGGER = (math.sqrt(5.0) - 1.0) / 2.0  # golden section: numbers of neighbours are far apart
_SCALES_M = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)


@dataclass(frozen=True)
class _Frame:
    """Transform from metres east and north to the picture's units, right and down."""

    west_m: float
    north_m: float
    per_m: float
    width: float
    height: float

    def at(self, east_m: float, north_m: float) -> tuple[float, float]:
        return (
            _MARGIN + (east_m - self.west_m) * self.per_m,
            _MARGIN + (self.north_m - north_m) * self.per_m,
        )

    def path(self, lines: Iterable[Line]) -> str:
        return "".join(self._path(line) for line in lines)

    def _path(self, line: Line) -> str:
        places = (f"{x:.1f} {y:.1f}" for x, y in (self.at(*one) for one in line))
        drawn = "L".join(places)
        # A line of one point is drawn as a dot by its round ends.
        return f"M{drawn}" if len(line) > 1 else f"M{drawn}h0"


def floors_of(plan: Plan | None, people: Iterable[PersonEntry]) -> list[int | None]:
    """Floors of the plan and of trails, highest first; an unknown floor last."""
    floors: set[int | None] = {trail.floor for one in people for trail in one.trails}
    if plan is not None:
        floors |= {storey.floor for storey in plan.storeys}
    return sorted(floors, key=lambda one: (one is None, -(one or 0)))


def floor_picture(
    floor: int | None, plan: Plan | None, people: Sequence[PersonEntry], *, small: bool = False
) -> Markup:
    """Picture of these people's trails on one floor."""
    walls = _walls(plan, floor)
    drawn = [(one, trail) for one in people for trail in one.trails if trail.floor == floor]
    lines = [line for _, trail in drawn for line in (*trail.in_contact, *trail.radio_gap)]
    size = (_SMALL_WIDTH, _SMALL_HEIGHT) if small else (_WIDTH, _MOST_HEIGHT)
    frame = _frame([*walls, *lines], *size)
    content = [
        element("path", d=frame.path(walls), **WALL),
        *(mark for one, trail in drawn for mark in _trail(frame, one, trail)),
        *(mark for one in people for mark in _ends(frame, one, floor, small=small)),
    ]
    if not small:
        content.extend(mark for one, trail in drawn for mark in _numbers(frame, one, trail))
        content.append(_north(frame))
    content.append(_scale(frame))
    return element(
        "svg",
        content,
        viewBox=f"0 0 {frame.width:.0f} {frame.height:.0f}",
        width=f"{frame.width:.0f}",
        height=f"{frame.height:.0f}",
        role="img",
        aria_label=texts.floor_name(floor),
    )


def _walls(plan: Plan | None, floor: int | None) -> list[Line]:
    """Lines of the plan on a floor; outlines are the same on each."""
    if plan is None:
        return []
    walls = [wall.line for wall in plan.walls if wall.floor == floor]
    stairs = [stairs.ring for stairs in plan.stairs if stairs.floor == floor]
    return [*plan.outlines, *walls, *stairs]


def _frame(lines: Sequence[Line], width: float, most_height: float) -> _Frame:
    easts = [east for line in lines for east, _ in line] or [0.0]
    norths = [north for line in lines for _, north in line] or [0.0]
    span_east_m = max(max(easts) - min(easts), _LEAST_M)
    span_north_m = max(max(norths) - min(norths), _LEAST_M)
    per_m = min((width - 2 * _MARGIN) / span_east_m, (most_height - 3 * _MARGIN) / span_north_m)
    return _Frame(
        west_m=min(easts),
        north_m=max(norths),
        per_m=per_m,
        width=max(per_m * span_east_m, 100.0) + 2 * _MARGIN,
        height=per_m * span_north_m + 3 * _MARGIN,
    )


def _trail(frame: _Frame, person: PersonEntry, trail: FloorTrail) -> Iterable[Markup]:
    colour = COLOURS[(person.number - 1) % len(COLOURS)]
    for lines, style in ((trail.in_contact, TRAIL), (trail.radio_gap, GAP)):
        if lines:
            yield element("path", d=frame.path(lines), stroke=colour, **style)


def _numbers(frame: _Frame, person: PersonEntry, trail: FloorTrail) -> Iterable[Markup]:
    """The person's number on the line: trails that run together are alike without colours."""
    first = _BESIDE_BEGIN + _NUMBER_EVERY * (person.number * _STAGGER % 1.0)
    number, width = str(person.number), 6.0 * len(str(person.number))
    for line in (*trail.in_contact, *trail.radio_gap):
        for x, y in places_along([frame.at(*one) for one in line], first, _NUMBER_EVERY):
            box = {"x": x - width / 2.0, "y": y - 5.0, "width": width, "height": 10.0}
            yield element("rect", **box, **PAPER)
            yield element("text", number, x=x, y=y + 3.5, **ON_LINE)


def places_along(
    points: Sequence[tuple[float, float]], first: float, every: float
) -> Iterator[tuple[float, float]]:
    """Points of a line, the first so far along it and then one for each ``every``."""
    ahead = first
    for (x, y), (next_x, next_y) in pairwise(points):
        length = math.hypot(next_x - x, next_y - y)
        while ahead <= length and length > 0.0:
            part = ahead / length
            yield x + part * (next_x - x), y + part * (next_y - y)
            ahead += every
        ahead -= length


def _ends(
    frame: _Frame, person: PersonEntry, floor: int | None, *, small: bool
) -> Iterable[Markup]:
    colour = COLOURS[(person.number - 1) % len(COLOURS)]
    if person.begin is not None and person.begin[0] == floor:
        x, y = frame.at(*person.begin[1:])
        yield element("circle", cx=x, cy=y, r=4.0, stroke=colour, **END)
    if person.end is not None and person.end[0] == floor:
        x, y = frame.at(*person.end[1:])
        yield element("rect", x=x - 3.5, y=y - 3.5, width=7.0, height=7.0, stroke=colour, **END)
        if not small:
            yield element("text", str(person.number), x=x + 6.0, y=y + 4.0, **NUMBER)


def _scale(frame: _Frame) -> Markup:
    """Scale bar with a round length."""
    room = min(frame.width - 2 * _MARGIN, 160.0) / frame.per_m
    length_m = max((one for one in _SCALES_M if one <= room), default=_SCALES_M[0])
    y = frame.height - 8.0
    end = _MARGIN + length_m * frame.per_m
    bar = f"M{_MARGIN:.1f} {y - 4:.1f}v4H{end:.1f}v-4"
    return element(
        "g",
        element("path", d=bar, **SCALE),
        element("text", f"{length_m} m", x=end + 5.0, y=y, **SMALL),
    )


def _north(frame: _Frame) -> Markup:
    x, y = frame.width - 12.0, 16.0
    return element(
        "g",
        element("path", d=f"M{x:.1f} {y + 18:.1f}V{y:.1f}l-3 6m3 -6l3 6", **SCALE),
        element("text", texts.NORTH, x=x - 4.0, y=y - 4.0, **SMALL),
    )
