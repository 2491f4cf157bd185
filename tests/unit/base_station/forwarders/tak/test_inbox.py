"""Inbox of other teams' events: valid ones are read, others refused, and the number is bounded."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from base_station.forwarders.tak.inbox import WAITING_MAX, ExternalInbox
from base_station.forwarders.tak.parsing import MarkerDeletion, NoMarkerError, read_event
from base_station.forwarders.tak.splitter import EVENT_BYTES_MAX, EventSplitter
from shared.clock import NS_PER_MS, NS_PER_S
from shared.messages import ExternalKind, ExternalMarker
from tests.rig.cot_events import cot_event
from tests.rig.tak_scene import ANCHOR, T_MS

NOW_NS = T_MS * NS_PER_MS
BOMB = (
    b'<?xml version="1.0"?><!DOCTYPE b [<!ENTITY a "lol"><!ENTITY c "&a;&a;&a;">]>'
    b'<event uid="u" type="a-f-G"><point/>&c;</event>'
)


class RecordingInbox:
    """An inbox, and its deliveries."""

    def __init__(self, within_m: float = 3000.0) -> None:
        self.markers: dict[str, ExternalMarker] = {}
        self.removed: list[str] = []
        self.inbox = ExternalInbox("county", "muster", within_m, self._deliver)

    def _deliver(self, markers: tuple[ExternalMarker, ...], removed: tuple[str, ...]) -> None:
        assert len(markers) <= WAITING_MAX
        self.markers |= {one.marker_id: one for one in markers}
        self.removed += removed

    def push(self, data: bytes, now_ns: int = 0) -> None:
        self.inbox.push(data, ANCHOR, NOW_NS)
        self.inbox.deliver_due(now_ns)


def test_person_of_another_team_is_read() -> None:
    marker = read_event("county", cot_event("p1", callsign="Police\n 1", remarks="a\x1fb" * 200))
    assert isinstance(marker, ExternalMarker)
    assert (marker.marker_id, marker.name) == ("county/p1", "Police 1")
    assert (marker.kind, marker.type) == (ExternalKind.PERSON, "a-f-G-U-C")
    assert (marker.lat_deg, marker.lon_deg, marker.radius_m) == (52.5, 13.4, 5.0)
    assert (marker.t_ns, marker.stale_ns - marker.t_ns) == (NOW_NS, 60 * NS_PER_S)
    assert len(marker.remarks) == 200


@pytest.mark.parametrize(
    ("kind", "shown"),
    [
        ("b-m-p-s-m", ExternalKind.MARKER),
        ("b-a-o-tbl", ExternalKind.EMERGENCY),
        ("a-h-G", ExternalKind.PERSON),
    ],
)
def test_kinds_follow_from_the_type(kind: str, shown: ExternalKind) -> None:
    marker = read_event("county", cot_event("u", kind=kind))
    assert isinstance(marker, ExternalMarker)
    assert marker.kind is shown


def test_event_that_is_no_marker_is_ignored() -> None:
    assert read_event("county", cot_event("takPong", kind="t-x-c-t-r")) is None
    assert read_event("county", cot_event("chat", kind="b-t-f")) is None


def test_deleted_marker_and_cancelled_emergency_are_removed() -> None:
    deleted = cot_event("x", kind="t-x-d-d", detail='<link uid="p1"/>')
    assert read_event("county", deleted) == MarkerDeletion("p1")
    assert read_event("county", cot_event("e", kind="b-a-o-can")) == MarkerDeletion("e")


@pytest.mark.parametrize(
    "raw",
    [
        BOMB,
        b"<event></event>",
        b'<event uid="u" type="a-f"></event>',
        b'<event uid="u" type="a-f"',
        b"\xff\xfe<event/>",
        b'<?xml version="1.0" encoding="nonsense"?><event uid="u" type="a-f"/>',
        cot_event("", callsign="x"),
        cot_event("u" * 200),
        cot_event("u", lat="nan"),
        cot_event("u", lat="91"),
        cot_event("u", lat="0", lon="0.0"),
        cot_event("u", lat="1e400"),
        cot_event("u", time="yesterday"),
        cot_event("u", time="9999-01-01T00:00:00Z"),
    ],
)
def test_impossible_event_is_refused(raw: bytes) -> None:
    with pytest.raises(NoMarkerError):
        read_event("county", raw)
    taken = RecordingInbox()
    taken.push(raw + cot_event("good"))
    assert set(taken.markers) == {"county/good"}


def test_events_come_in_any_pieces() -> None:
    whole = b'<?xml version="1.0"?>' + cot_event("a") + b"\n" + cot_event("b")
    for size in (1, 7, 100):
        splitter, events = EventSplitter(), []
        for begin in range(0, len(whole), size):
            events += splitter.push(whole[begin : begin + size])
        assert events == [cot_event("a"), cot_event("b")]


def test_endless_rubbish_takes_bounded_memory() -> None:
    splitter = EventSplitter()
    for _ in range(100):
        assert splitter.push(b"<event " + b"x" * 10_000) == []
        assert len(splitter._buffer) <= EVENT_BYTES_MAX
    assert splitter.dropped_bytes > 900_000
    assert splitter.push(b"</event>" + cot_event("a"))[-1:] == [cot_event("a")]


def test_ten_thousand_markers_are_bounded() -> None:
    taken = RecordingInbox()
    taken.push(b"".join(cot_event(f"m{number}") for number in range(10_000)))
    assert len(taken.markers) == WAITING_MAX
    assert taken.inbox.refused == 10_000 - WAITING_MAX
    taken.push(cot_event("later"), NS_PER_S)
    assert "county/later" in taken.markers


def test_newest_of_many_positions_in_a_second_is_delivered() -> None:
    taken = RecordingInbox()
    taken.push(cot_event("p"), 0)
    taken.push(cot_event("p", lat="52.501"), NS_PER_S // 2)
    taken.push(cot_event("p", lat="52.502"), NS_PER_S // 2)
    assert taken.markers["county/p"].lat_deg == 52.5
    taken.inbox.deliver_due(NS_PER_S)
    assert taken.markers["county/p"].lat_deg == 52.502


def test_own_people_and_distant_ones_are_left_out() -> None:
    taken = RecordingInbox(within_m=500.0)
    taken.push(cot_event("muster.FF-01") + cot_event("far", lat="52.51") + cot_event("near"))
    assert set(taken.markers) == {"county/near"}
    taken.inbox.push(cot_event("other"), None, NOW_NS)
    taken.inbox.deliver_due(5 * NS_PER_S)
    assert set(taken.markers) == {"county/near"}, "without an anchor nobody knows where it is"


def test_clock_ahead_does_not_extend_the_validity() -> None:
    taken = RecordingInbox()
    taken.push(cot_event("p", time="2023-11-14T23:13:20.000Z", stale="2023-11-14T23:14:20Z"))
    marker = taken.markers["county/p"]
    assert marker.t_ns == NOW_NS
    assert marker.stale_ns == NOW_NS + 60 * NS_PER_S


def test_expired_person_is_removed() -> None:
    taken = RecordingInbox()
    gone: Callable[[str], bytes] = lambda uid: cot_event(  # noqa: E731  # one line a use
        "x", kind="t-x-d-d", detail=f'<link uid="{uid}"/>'
    )
    taken.push(cot_event("p") + gone("p") + gone("q") + cot_event("q"))
    assert taken.removed == ["county/p"]
    assert set(taken.markers) == {"county/q"}
