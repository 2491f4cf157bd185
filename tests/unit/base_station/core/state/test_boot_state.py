"""Clock of a unit relative to the station's, and which of its messages are live."""

from __future__ import annotations

import pytest

from base_station.core.state.boot_state import BootState
from base_station.core.state.boot_state import event_time_ns as expected_event_time_ns
from shared.clock import NS_PER_S
from shared.messages import Header

STATION_NS = 1_700_000_000 * NS_PER_S
UPTIME_NS = 1000 * NS_PER_S


def ns(seconds: float) -> int:
    return round(seconds * NS_PER_S)


class Unit:
    """Messages of a unit's boot, in seconds since its first message."""

    def __init__(self) -> None:
        self.boot = BootState(7)

    def note_message(
        self, at_s: float, slower_s: float = 0.0, utc_error_s: float | None = None, std_s: float = 0
    ) -> bool:
        """A message that took so much longer than the quickest; utc_error_s: that of the unit."""
        captured_s = at_s - slower_s
        utc_ns = 0 if utc_error_s is None else STATION_NS + ns(captured_s + utc_error_s)
        header = Header("FF-01", 7, 1, UPTIME_NS + ns(captured_s), utc_ns, std_s)
        return self.boot.note(STATION_NS + ns(at_s), header)

    def placed_s(self, captured_s: float) -> float:
        """Station time of a capture."""
        return (self.boot.station_ns(UPTIME_NS + ns(captured_s)) - STATION_NS) / NS_PER_S


@pytest.mark.parametrize(("slower_s", "now"), [(0.0, True), (4.9, True), (5.1, False)])
def test_message_is_live_when_it_was_hardly_delayed(slower_s: float, now: bool) -> None:
    unit = Unit()
    assert unit.note_message(0.0)
    assert unit.note_message(10.0, slower_s) is now
    assert unit.boot.first_live_ns == STATION_NS
    newest_s = 10.0 - slower_s if now else 0.0
    assert unit.boot.last_live_ns == pytest.approx(STATION_NS + ns(newest_s), abs=ns(0.01))


def test_message_quicker_than_any_before_bounds_its_capture_by_its_reception() -> None:
    unit = Unit()
    unit.note_message(0.0)
    assert unit.note_message(10.0, slower_s=-2.0)
    assert unit.boot.last_live_ns == STATION_NS + ns(10.0)
    assert unit.placed_s(12.0) == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("utc_error_s", "std_s", "now"),
    [
        (-59.0, 0.1, True),
        (-61.0, 0.1, False),
        (61.0, 0.1, False),
        (-3600.0, 0.0, True),  # it does not know the time, and states so
    ],
)
def test_message_with_another_known_time_is_not_live(
    utc_error_s: float, std_s: float, now: bool
) -> None:
    assert Unit().note_message(0.0, utc_error_s=utc_error_s, std_s=std_s) is now


@pytest.mark.parametrize(
    ("utc_error_s", "std_s", "placed_s"),
    [
        (-1.0, 0.01, -1.0),  # all messages take a second
        (-29.0, 0.01, -29.0),
        (-31.0, 0.01, 0.0),  # no link is so slow
        (0.04, 0.001, 0.04),
        (0.2, 0.001, 0.0),  # received before it was sent
        (0.2, 0.1, 0.2),
        (0.4, 0.1, 0.0),
        (-1.0, 0.0, 0.0),  # it has no estimate
    ],
)
def test_estimate_of_the_unit_is_used_where_possible(
    utc_error_s: float, std_s: float, placed_s: float
) -> None:
    unit = Unit()
    unit.note_message(0.0, utc_error_s=utc_error_s, std_s=std_s)
    assert unit.placed_s(0.0) == pytest.approx(placed_s, abs=1e-6)


def test_lost_estimate_is_not_kept() -> None:
    unit = Unit()
    unit.note_message(0.0, utc_error_s=-1.0, std_s=0.01)
    unit.note_message(1.0)
    assert unit.placed_s(1.0) == pytest.approx(1.0, abs=1e-3)


def test_clock_that_was_set_is_used_after_twenty_messages_in_a_row() -> None:
    unit = Unit()
    unit.note_message(0.0)
    for second in range(1, 20):
        unit.note_message(100.0 + second, slower_s=90.0)
    assert unit.placed_s(30.0) == pytest.approx(30.0, abs=0.1)
    unit.note_message(120.0)  # one that is not late: a delayed link, and no set clock
    for second in range(1, 20):
        unit.note_message(220.0 + second, slower_s=90.0)
    assert unit.placed_s(150.0) == pytest.approx(150.0, abs=0.1)
    assert unit.note_message(240.0, slower_s=90.0)
    assert unit.placed_s(150.0) == pytest.approx(240.0, abs=0.1)


@pytest.mark.parametrize(("slower_s", "is_taken"), [(59.9, False), (60.1, True)])
def test_link_that_is_slow_for_long_is_no_set_clock(slower_s: float, is_taken: bool) -> None:
    unit = Unit()
    unit.note_message(0.0)
    for second in range(25):
        unit.note_message(100.0 + second / 10, slower_s=slower_s)
    assert (unit.placed_s(0.0) > 50.0) is is_taken
    assert unit.placed_s(0.0) == pytest.approx(slower_s if is_taken else 0.0, abs=0.1)


@pytest.mark.parametrize(
    ("utc_error_s", "std_s", "stated_s"),
    [(0.0, 0.1, -30.0), (40.0, 0.1, 0.0), (0.0, 0.0, None)],
    ids=["it knew the time", "it is ahead", "it knew no time"],
)
@pytest.mark.parametrize("boots", [(), (BootState(6),), (BootState(7),)])
def test_run_without_live_messages_is_dated_by_the_unit(
    boots: tuple[BootState, ...], utc_error_s: float, std_s: float, stated_s: float | None
) -> None:
    """Thirty seconds ago by the station's clock; nothing is dated later than its reception."""
    header = Header("FF-01", 7, 1, UPTIME_NS, STATION_NS + ns(utc_error_s - 30.0), std_s)
    event_time_ns = None if stated_s is None else STATION_NS + ns(stated_s)
    assert expected_event_time_ns(boots, header, STATION_NS) == event_time_ns
