"""CAP alerts: their places, their duration, replacements, and hostile ones."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest

from base_station.dispatch.alert_intake import AlertIntake
from base_station.dispatch.cap import MOST_SHAPES, CapAlert, marker_ids, read_alert
from shared.clock import NS_PER_S
from shared.errors import WireError
from shared.messages import ExternalMarker

NOW_NS = round(datetime(2026, 3, 1, 13, 10, tzinfo=UTC).timestamp()) * NS_PER_S
HOUR_NS = 3600 * NS_PER_S
CIRCLE = "<circle>52.5,13.4 0.5</circle>"
POLYGON = "<polygon>52.4,13.3 52.4,13.5 52.6,13.5 52.6,13.3 52.4,13.3</polygon>"


def alert(
    shapes: str = CIRCLE,
    *,
    identifier: str = "a1",
    status: str = "Actual",
    kind: str = "Alert",
    references: str = "",
    expires: str = "<expires>2026-03-01T16:00:00+01:00</expires>",
    sent: str = "2026-03-01T13:00:00-00:00",
    version: str = "1.2",
) -> bytes:
    return f"""<?xml version="1.0" encoding="UTF-8"?>
    <alert xmlns="urn:oasis:names:tc:emergency:cap:{version}"><identifier>{identifier}</identifier>
    <sender>weather@example.org</sender><sent>{sent}</sent><status>{status}</status>
    <msgType>{kind}</msgType><scope>Public</scope><references>{references}</references>
    <info><language>de</language><event>Sturm</event><severity>Severe</severity>{expires}
    <area><areaDesc>Stadt</areaDesc>{shapes}</area></info>
    <info><language>en-GB</language><event>Storm</event><severity>Severe</severity>{expires}
    <headline>Gale</headline><instruction>Stay inside.</instruction>
    <area><areaDesc>Town</areaDesc>{shapes}</area></info></alert>""".encode()


def read(body: bytes) -> CapAlert:
    return read_alert(body, NOW_NS)


def test_circle_is_a_marker_until_it_expires() -> None:
    shown = read(alert())
    assert (shown.alert_id, shown.outcome) == ("weather@example.org,a1", "shown")
    (marker,) = shown.markers
    assert (marker.name, marker.type, marker.source) == ("Gale", "Storm", "CAP")
    assert marker.remarks == "Town; Severe; Stay inside."
    assert (marker.lat_deg, marker.lon_deg, marker.radius_m) == (52.5, 13.4, 500.0)
    assert marker.t_ns == NOW_NS - HOUR_NS // 6
    assert marker.stale_ns == NOW_NS + 2 * HOUR_NS - HOUR_NS // 6
    assert read(alert(version="1.1")).markers == shown.markers


def test_polygon_has_the_circle_that_covers_it() -> None:
    (marker,) = read(alert(POLYGON)).markers
    assert marker.lat_deg == pytest.approx(52.5)
    assert marker.lon_deg == pytest.approx(13.4)
    assert marker.radius_m == pytest.approx(13_020, abs=100)  # half of 22.2 km by 13.6 km


def test_alert_without_an_end_holds_for_a_day_and_none_longer_than_a_week() -> None:
    (open_end,) = read(alert(expires="")).markers
    assert open_end.stale_ns == open_end.t_ns + 24 * HOUR_NS
    endless = read(alert(expires="<expires>2099-01-01T00:00:00Z</expires>"))
    assert endless.markers[0].stale_ns == NOW_NS + 7 * 24 * HOUR_NS
    assert len(endless.warnings) == 1
    unzoned = read(alert(expires="<expires>2026-03-01T16:00:00</expires>"))
    assert unzoned.markers[0].stale_ns == open_end.stale_ns
    assert len(unzoned.warnings) == 1
    ahead = read(
        alert(sent="2026-03-01T20:00:00Z", expires="<expires>2026-03-01T21:00:00Z</expires>")
    )
    assert ahead.markers[0].t_ns == NOW_NS  # of a clock that is ahead


@pytest.mark.parametrize(
    ("body", "outcome"),
    [
        (alert(expires="<expires>2026-03-01T13:00:00Z</expires>"), "expired"),
        (alert(status="Exercise"), "not actual"),
        (alert(status="Test"), "not actual"),
        (alert(kind="Ack"), "not actual"),
        (alert(""), "without a place"),
        (alert("<circle>0,0 1</circle>"), "without a place"),
        (alert("<circle>here</circle>"), "without a place"),
        (alert("<circle>52.5,13.4 -1</circle>"), "without a place"),
        (alert("<circle>52.5,13.4 nan</circle>"), "without a place"),
        (alert("<polygon>52,13 53,13 52,13</polygon>"), "without a place"),
        (alert("<polygon>52,13 53,13 53,14 52,14</polygon>"), "without a place"),
        (alert("<circle>95,13.4 1</circle>"), "without a place"),
    ],
)
def test_irrelevant_alerts_are_not_shown(body: bytes, outcome: str) -> None:
    read_one = read(body)
    assert (read_one.outcome, read_one.markers) == (outcome, ())


def test_flood_of_areas_is_cut_off_and_named() -> None:
    shown = read(alert(CIRCLE * 10_000))
    assert [one.marker_id for one in shown.markers] == list(marker_ids(shown.alert_id))
    assert any(str(10_000 - MOST_SHAPES) in one for one in shown.warnings)


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"rubbish",
        b"{}",
        b"<alert>",
        b"<event/>",
        b'<!DOCTYPE lolz [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><alert>&b;</alert>',
        b'<!DOCTYPE x SYSTEM "file:///etc/passwd"><alert/>',
        b'<?xml version="1.0" encoding="x-none"?><alert/>',
        alert(identifier=""),
        alert(identifier="x" * 200),
    ],
)
def test_text_that_is_no_alert_is_refused(body: bytes) -> None:
    with pytest.raises(WireError):
        read(body)


class Plan:
    """The markers of other systems that consoles show."""

    def __init__(self) -> None:
        self.shown: dict[str, ExternalMarker] = {}
        self.intake = AlertIntake(self._change)

    def _change(self, markers: tuple[ExternalMarker, ...], gone: tuple[str, ...]) -> None:
        for marker_id in gone:
            self.shown.pop(marker_id, None)
        self.shown |= {one.marker_id: one for one in markers}

    def take(self, body: bytes) -> CapAlert:
        return self.intake.take(read(body))


REFERENCE = "weather@example.org,a1,2026-03-01T13:00:00-00:00"


def test_update_replaces_and_a_cancellation_removes() -> None:
    plan = Plan()
    plan.take(alert(3 * CIRCLE))
    plan.take(alert(CIRCLE))  # again, with fewer areas
    assert len(plan.shown) == 1
    update = alert(POLYGON, identifier="a2", kind="Update", references=REFERENCE)
    assert plan.take(update).replaced == ("weather@example.org,a1",)
    assert list(plan.shown) == ["CAP/weather@example.org,a2/0"]
    cancel = alert("", identifier="a3", kind="Cancel", references=REFERENCE.replace("a1", "a2"))
    assert plan.take(cancel).outcome == "cancelled"
    assert plan.shown == {}


def test_alert_behind_its_own_cancellation_is_not_shown() -> None:
    plan = Plan()
    plan.take(alert(identifier="a3", kind="Cancel", references=REFERENCE))
    assert plan.take(alert()).outcome == "replaced"
    assert plan.shown == {}


def test_cancelled_exercise_removes_nothing() -> None:
    plan = Plan()
    plan.take(alert())
    plan.take(alert(identifier="a3", kind="Cancel", status="Exercise", references=REFERENCE))
    assert len(plan.shown) == 1


def test_cancellation_without_alert_is_named() -> None:
    assert read(alert(kind="Cancel")).warnings == ("it names no alert that it updates or cancels",)
