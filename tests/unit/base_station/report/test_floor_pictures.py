"""Pictures of floors, as they are read without colours."""

from __future__ import annotations

import re
from itertools import product

import pytest

from base_station.report.contents import FloorTrail, Interval, PersonEntry, WornTime
from base_station.report.floor_pictures import floor_picture, places_along

LINE = tuple((float(east_m), 0.0) for east_m in range(61))
TEXT = re.compile(r'<text x="([\d.]+)" y="[\d.]+"[^>]*font-weight="bold"[^>]*>(\d+)</text>')


def entry(number: int) -> PersonEntry:
    """One who has walked along the line, where all the others have."""
    during = Interval(0, 1)
    return PersonEntry(
        number=number,
        wearing=WornTime(f"FF-{number}", "", "", "", during),
        positions=len(LINE),
        distance_m=60.0,
        inside_s=None,
        floors=(),
        hottest=None,
        dose=0.0,
        radio_gaps=(),
        trails=(FloorTrail(0, (LINE,), ()),),
        begin=(0, 0.0, 0.0),
        end=(0, 60.0, 0.0),
    )


def test_trails_that_run_together_bear_their_numbers() -> None:
    picture = floor_picture(0, None, [entry(number) for number in (1, 2, 3)])
    numbers = [(int(number), float(x)) for x, number in TEXT.findall(str(picture))]
    on_lines = [(number, x) for number, x in numbers if x < 660.0]  # not those at the ends
    for number in (1, 2, 3):
        assert len([x for one, x in on_lines if one == number]) >= 4
    for (one, x), (other, other_x) in product(on_lines, repeat=2):
        assert one == other or abs(x - other_x) > 8.0, (one, other)


def test_small_picture_of_one_person_has_no_numbers() -> None:
    assert TEXT.findall(str(floor_picture(0, None, [entry(1)], small=True))) == []


@pytest.mark.parametrize(
    ("points", "places"),
    [
        ([(0.0, 0.0), (3.0, 4.0), (3.0, 14.0)], [(1.2, 1.6), (3.0, 7.0), (3.0, 13.0)]),
        ([(0.0, 0.0), (0.0, 0.0), (0.0, 2.0)], [(0.0, 2.0)]),
        ([(0.0, 0.0)], []),
        ([], []),
    ],
)
def test_places_along_a_line(
    points: list[tuple[float, float]], places: list[tuple[float, float]]
) -> None:
    found = list(places_along(points, 2.0, 6.0))
    assert found == [pytest.approx(one) for one in places]
