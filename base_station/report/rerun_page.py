"""Re-run as one HTML page: tables, and the old and new trails over each other on each floor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from base_station.replay.rerun.comparison import RerunReport
from base_station.replay.rerun.tables import covered, figures, time_text
from base_station.report import texts
from base_station.report.contents import FloorTrail, Interval, PersonEntry, WornTime
from base_station.report.floor_pictures import floor_picture, floors_of
from base_station.report.markup import Markup, element, table
from base_station.report.style import STYLE
from base_station.report.trail import measure
from base_station.site.plan import Plan
from base_station.storage.db.records import TrackSample

_POLICY = "default-src 'none'; style-src 'unsafe-inline'"
_HEADINGS = (
    *("unit", "tracker", "again", "median m", "95 % m", "most m", "at the end m"),
    *("height 95 % m", "other floor s"),
)

Trails = Mapping[str, Sequence[TrackSample]]


def rerun_page(
    report: RerunReport, plan: Plan | None, shown: Trails, rerun: Trails, names: Mapping[str, str]
) -> bytes:
    """Page of a re-run.  ``names``: names of people, by unit.  Solid lines: the re-run; dashed
    lines: trails as they were shown.
    """
    title = f"Re-run of {report.incident_id}"
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", http_equiv="Content-Security-Policy", content=_POLICY),
        element("title", title),
        element("style", Markup(STYLE)),
    )
    body = element(
        "body", element("main", element("h1", title), _content(report, plan, shown, rerun, names))
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n".encode()


def _content(
    report: RerunReport, plan: Plan | None, shown: Trails, rerun: Trails, names: Mapping[str, str]
) -> list[Markup]:
    people = [
        _person(number, unit_id, names.get(unit_id, ""), plan, shown, rerun)
        for number, unit_id in enumerate(sorted({*shown, *rerun}), 1)
    ]
    what = [
        f"tracker: {report.tracker or 'as the unit'}",
        f"calibration: {report.calibration or 'as the unit'}",
        *report.settings,
        f"Muster {report.version}",
    ]
    trails = [
        (
            f"{names.get(one.unit_id, '')} ({one.unit_id})".strip(),
            one.tracker,
            covered(one),
            *figures(one),
            str(one.other_floor_s),
        )
        for one in report.trails
    ]
    alarms = [
        (one.unit_id, one.rule, one.outcome.value, time_text(one.shown_ms), time_text(one.rerun_ms))
        for one in report.alarms
    ]
    return [
        element("p", ", ".join(what)),
        *(element("p", note, class_="note") for note in report.notes),
        element("h2", "Trails"),
        table(_HEADINGS, trails),
        *_pictures(plan, people),
        element("h2", "Alarms"),
        table(("unit", "rule", "re-run", "then, UTC", "now, UTC"), alarms),
    ]


def _pictures(plan: Plan | None, people: Sequence[PersonEntry]) -> list[Markup]:
    numbers = ", ".join(f"{one.number} {one.wearing.name or one.wearing.unit_id}" for one in people)
    return [
        element(
            "figure",
            element("figcaption", f"{texts.floor_name(floor)}: {numbers}"),
            floor_picture(floor, plan, people),
            element("p", "solid: re-run; dashed: as it was shown", class_="note"),
        )
        for floor in floors_of(plan, people)
    ]


def _person(
    number: int, unit_id: str, name: str, plan: Plan | None, shown: Trails, rerun: Trails
) -> PersonEntry:
    """Person whose re-run is drawn as a received trail, and whose shown trail is drawn as in a
    radio gap.
    """
    new, old = rerun.get(unit_id, ()), shown.get(unit_id, ())
    figures_of_new = measure(new, plan, ())
    floors: dict[int | None, FloorTrail] = {one.floor: one for one in figures_of_new.trails}
    for one in measure(old, plan, ()).trails:
        both = floors.get(one.floor, FloorTrail(one.floor, (), ()))
        floors[one.floor] = msgspec.structs.replace(both, radio_gap=one.in_contact)
    return PersonEntry(
        number=number,
        wearing=WornTime(unit_id, name, "", "", Interval(0, 0)),
        positions=len(new),
        distance_m=figures_of_new.distance_m,
        inside_s=figures_of_new.inside_s,
        floors=figures_of_new.floors,
        hottest=None,
        dose=0.0,
        radio_gaps=(),
        trails=tuple(floors.values()),
        begin=(new[0].floor, new[0].east_m, new[0].north_m) if new else None,
        end=(new[-1].floor, new[-1].east_m, new[-1].north_m) if new else None,
    )
