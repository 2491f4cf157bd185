"""Report as one HTML file that contains its pictures and styles; the same contents give the same
bytes.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence

from base_station.replay.assessment.report import UnitReport
from base_station.report import texts
from base_station.report.contents import (
    OrderEntry,
    OrderReceipt,
    PersonEntry,
    PhotoEntry,
    Photographs,
    ReportContents,
)
from base_station.report.floor_pictures import floor_picture, floors_of
from base_station.report.markup import JPEG_ADDRESS, Markup, UrgentRow, element, joined, table
from base_station.report.orders import ASKED_PAR
from base_station.report.style import STYLE
from base_station.report.trace_pictures import trace_picture

# The page does nothing but show itself, whatever comes to be in it.
_POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"

_MOST_URGENT = 12


def html_document(report: ReportContents) -> bytes:
    title = f"{texts.TITLE}: {report.name}"
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", http_equiv="Content-Security-Policy", content=_POLICY),
        element("meta", name="viewport", content="width=device-width"),
        element("title", title),
        element("style", Markup(STYLE)),
    )
    body = element("body", element("main", element("h1", title), _sections(report)))
    page = element("html", head, body, lang="en")
    return f"<!DOCTYPE html>\n{page}\n".encode()


def _sections(report: ReportContents) -> Iterable[Markup]:
    yield _summary(report)
    yield _section(texts.TIMELINE, _timeline(report))
    yield _section(texts.PAR, _roll_calls(report))
    yield _section(texts.ORDERS, _orders(report))
    yield _section(texts.PLAN, _plan(report))
    yield _section(texts.PEOPLE, _people(report))
    yield _section(texts.TRACES, _traces(report))
    if report.imports:
        yield _section(texts.IMPORTS, _imports(report))
    if report.photographs.entries:
        yield _section(texts.PHOTOGRAPHS, _photographs(report.photographs))
    yield _section(texts.POSITIONS, _positions(report))
    yield _section(texts.RECORD, _record(report))
    yield _section(texts.SETTINGS, _settings(report))


def _section(heading: str, content: Markup) -> Markup:
    return element("section", element("h2", heading), content)


def _summary(report: ReportContents) -> Markup:
    rows = (joined(element("dt", name), element("dd", value)) for name, value in _facts(report))
    return element(
        "section",
        element("p", texts.OPEN_INCIDENT, class_="warning") if report.is_open else "",
        element("dl", rows),
        _urgent(report),
        element("p", texts.PREPARED, class_="note"),
    )


def _urgent(report: ReportContents) -> Markup:
    """Urgent entries, for a reader in a hurry; the timeline has all entries."""
    urgent = [one for one in report.timeline if one.is_urgent]
    shown = (
        element("li", f"{texts.clock_time(one.t_ns)} {one.text}") for one in urgent[:_MOST_URGENT]
    )
    left_out = len(urgent) - _MOST_URGENT
    more = element("li", texts.more_in_timeline(left_out)) if left_out > 0 else ""
    return element("ul", shown, more, class_="warning") if urgent else Markup()


def _facts(report: ReportContents) -> Iterable[tuple[str, str]]:
    people = {(one.wearing.name or one.wearing.unit_id) for one in report.people}
    urgent = sum(one.is_urgent and one.kind == texts.ALARM for one in report.timeline)
    during = report.during
    yield texts.INCIDENT, f"{report.name} ({report.incident_id})"
    if report.dispatch:
        yield texts.DISPATCH, report.dispatch
    yield texts.OPENED, texts.time_and_author(during.from_ns, report.opened_by)
    if report.is_open:
        yield texts.CLOSED, texts.STILL_OPEN
    else:
        yield texts.CLOSED, texts.time_and_author(during.until_ns, report.closed_by)
    yield texts.LASTED, texts.duration(during.seconds)
    yield texts.PEOPLE, str(len(people))
    yield texts.ALARMS, texts.alarm_count_text(report.alarms, urgent)
    yield texts.ORDERS, str(len(report.orders))
    yield texts.RADIO_GAPS, str(sum(len(one.radio_gaps) for one in report.people))
    yield texts.RECORD, str(len(report.defects)) if report.defects else texts.NONE


def _timeline(report: ReportContents) -> Markup:
    if not report.timeline:
        return element("p", texts.NO_TIMELINE)
    rows = (
        (UrgentRow if one.is_urgent else tuple)(
            (texts.clock_time(one.t_ns), one.kind, one.text, one.by)
        )
        for one in report.timeline
    )
    return table(texts.HEAD_TIMELINE, rows, "timeline")


def _roll_calls(report: ReportContents) -> Markup:
    asked = [one for one in report.orders if one.kind == ASKED_PAR and not one.is_repeat]
    if not asked:
        return element("p", texts.NO_PAR)
    rows = (
        (
            texts.clock_time(one.t_ns),
            one.by,
            str(len(one.receipts)),
            _lines(_acknowledged(one)),
            _lines(_unanswered(one)),
        )
        for one in asked
    )
    return table(texts.HEAD_PAR, rows)


def _orders(report: ReportContents) -> Markup:
    others = [one for one in report.orders if one.kind != ASKED_PAR]
    if not others:
        return element("p", texts.NO_ORDERS)
    rows = (
        (
            texts.clock_time(one.t_ns),
            _order_words(one),
            one.by,
            str(len(one.receipts)),
            _lines(_acknowledged(one)),
            _lines(
                texts.not_acknowledged(receipt, receipt.unit_id)
                for receipt in one.receipts
                if not _is_done(receipt)
            ),
        )
        for one in others
    )
    return table(texts.HEAD_ORDERS, rows)


def _order_words(order: OrderEntry) -> str:
    name = texts.order_name(order.kind)
    words = texts.sent_again(name) if order.is_repeat else name
    return f"{words}: {order.text}" if order.text else words


def _acknowledged(order: OrderEntry) -> Iterable[str]:
    return (
        texts.acknowledged(one, one.unit_id, order.t_ns) for one in order.receipts if _is_done(one)
    )


def _unanswered(order: OrderEntry) -> Iterable[str]:
    return (one.unit_id for one in order.receipts if not _is_done(one))


def _is_done(receipt: OrderReceipt) -> bool:
    return receipt.acknowledged_ns is not None or receipt.radio_ns is not None


def _lines(lines: Iterable[str]) -> Markup:
    return joined(element("div", one) for one in lines)


def _plan(report: ReportContents) -> Markup:
    notes = [
        *([] if report.plan else [texts.NO_PLAN]),
        *([] if report.has_anchor else [texts.NO_ANCHOR]),
    ]
    if not any(one.positions for one in report.people):
        notes.append(texts.NO_POSITIONS)
    damage = [report.plan.damage] if report.plan is not None and report.plan.damage else []
    pictures = (
        element(
            "figure",
            element("h3", texts.floor_name(floor)),
            floor_picture(floor, report.plan, report.people),
        )
        for floor in floors_of(report.plan, report.people)
    )
    return joined(
        element("p", texts.TRAILS_KEY, class_="note"),
        (element("p", one, class_="warning") for one in (*notes, *damage)),
        pictures,
    )


def _people(report: ReportContents) -> Markup:
    if not report.people:
        return element("p", texts.NO_PEOPLE)
    return joined(
        element("p", texts.PEOPLE_KEY, class_="note"),
        table(texts.HEAD_PEOPLE, map(_person_row, report.people), "people"),
        (_person(report, one) for one in report.people if one.trails),
    )


def _person_row(one: PersonEntry) -> Sequence[str]:
    wearing = one.wearing
    name = wearing.name or texts.NOT_ASSIGNED
    gaps_s = sum(gap.seconds for gap in one.radio_gaps)
    return (
        str(one.number),
        f"{name}, {wearing.crew}" if wearing.crew else name,
        wearing.unit_id,
        texts.from_to(wearing.during.from_ns, wearing.during.until_ns),
        f"{one.distance_m:.0f} m" if one.positions else texts.UNKNOWN,
        texts.UNKNOWN if one.inside_s is None else texts.duration(one.inside_s),
        _lines(f"{texts.floor_name(floor)}: {texts.duration(s)}" for floor, s in one.floors),
        texts.UNKNOWN if one.hottest is None else texts.hottest(*one.hottest),
        texts.UNKNOWN if one.hottest is None else f"{one.dose:.0%}",
        f"{len(one.radio_gaps)}, {texts.duration(gaps_s)}" if one.radio_gaps else texts.NONE,
    )


def _person(report: ReportContents, one: PersonEntry) -> Markup:
    name = one.wearing.name or one.wearing.unit_id
    pictures = (
        element(
            "figure",
            element("figcaption", texts.floor_name(trail.floor)),
            floor_picture(trail.floor, report.plan, [one], small=True),
        )
        for trail in one.trails
    )
    gaps = ", ".join(texts.from_to(gap.from_ns, gap.until_ns) for gap in one.radio_gaps)
    return element(
        "article",
        element("h3", f"{one.number}. {name} ({one.wearing.unit_id})"),
        element("p", texts.radio_gaps(gaps)) if gaps else "",
        element("div", pictures, class_="small-pictures"),
    )


def _traces(report: ReportContents) -> Markup:
    if not report.alarms:
        return element("p", texts.NO_ALARMS)
    pictures = (
        element("figure", element("figcaption", f"{one.text} ({one.rule})"), trace_picture(one))
        for one in report.traces
    )
    left_out = report.traces_left_out
    return joined(
        element("p", texts.TRACES_KEY, class_="note"),
        element("p", texts.traces_left_out(left_out), class_="warning") if left_out else "",
        element("div", pictures, class_="small-pictures"),
    )


def _imports(report: ReportContents) -> Markup:
    rows = (
        (
            one.file_name,
            one.format,
            texts.from_to(one.during.from_ns, one.during.until_ns),
            f"{one.shift_s:g}",
            texts.time_and_author(one.t_ns, one.by),
            one.sha256,
        )
        for one in report.imports
    )
    return joined(element("p", texts.IMPORTS_KEY, class_="note"), table(texts.HEAD_IMPORTS, rows))


def _photographs(found: Photographs) -> Markup:
    left_out = found.left_out
    return joined(
        element("p", texts.PHOTOGRAPHS_KEY, class_="note"),
        element("p", texts.photographs_left_out(left_out), class_="warning") if left_out else "",
        element("div", map(_photograph, found.entries), class_="photographs"),
    )


def _photograph(one: PhotoEntry) -> Markup:
    if one.jpeg:
        address = f"{JPEG_ADDRESS}{b64encode(one.jpeg).decode()}"
        picture = element("img", src=address, alt=one.file_name)
    else:
        picture = element("p", one.fault, class_="warning")
    caption = element(
        "figcaption", one.file_name, element("div", texts.photograph_caption(one), class_="note")
    )
    return element("figure", picture, caption)


def _positions(report: ReportContents) -> Markup:
    if report.assessment is None:
        return element("p", texts.NO_ASSESSMENT)
    return joined(
        element("p", texts.POSITIONS_KEY, class_="note"),
        table(texts.HEAD_POSITIONS, map(_position_row, report.assessment.units)),
    )


def _position_row(unit: UnitReport) -> Sequence[str]:
    trust = unit.trust
    total_s = trust.green_s + trust.amber_s + trust.red_s
    lights = (trust.green_s, trust.amber_s, trust.red_s)
    people = ", ".join(unit.people)
    return (
        f"{people} ({unit.unit_id})" if people else unit.unit_id,
        " ".join(f"{one / total_s:.0%}" for one in lights) if total_s else texts.UNKNOWN,
        trust.causes[0][0] if trust.causes else "",
        texts.UNKNOWN if unit.stated is None else f"{unit.stated.ce95_m:.1f} m",
        texts.UNKNOWN if unit.against_smoothed is None else f"{unit.against_smoothed.ce95_m:.1f} m",
        texts.UNKNOWN if unit.floor_right is None else f"{unit.floor_right:.0%}",
    )


def _record(report: ReportContents) -> Markup:
    if not report.defects:
        return element("p", texts.NO_DEFECTS)
    return element("ul", (element("li", one) for one in report.defects), class_="warning")


def _settings(report: ReportContents) -> Markup:
    thresholds = (
        (name, _plain(now), _plain(default), texts.CHANGED if now != default else "")
        for name, now, default in report.thresholds
    )
    units = (
        (one.unit_id, one.software_version, one.tracker, one.calibration) for one in report.units
    )
    return joined(
        element("p", texts.made_by(report.version, report.par_interval_s, report.work_limit_s)),
        table(texts.HEAD_THRESHOLDS, thresholds, "short"),
        table(texts.HEAD_UNITS, units),
    )


def _plain(value: float) -> str:
    return f"{value:g}"
