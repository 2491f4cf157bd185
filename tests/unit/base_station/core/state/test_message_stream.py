"""Order of one sender's messages: which are received, and which are of the present."""

from __future__ import annotations

import pytest

from base_station.core.state.message_stream import (
    BOOTS_KEPT,
    RESTART_STORM_NS,
    STARTS_KEPT,
    MessageStream,
)
from shared.channels import EVENT, GPS, POSITION, STATUS, Channel
from shared.clock import NS_PER_S
from shared.messages import Header

NOW_NS = 1_700_000_000 * NS_PER_S


def header_of(seq: int, mono_s: float = 100.0, boot_id: int = 7) -> Header:
    return Header("FF-01", boot_id, seq, round(mono_s * NS_PER_S))


@pytest.fixture
def sender() -> MessageStream:
    """The sender after the fifth message of its run, of its hundredth second."""
    sender = MessageStream("FF-01")
    assert sender.accept(STATUS, header_of(5), NOW_NS) == "new"
    return sender


@pytest.mark.parametrize(
    ("channel", "seq", "mono_s", "worth"),
    [
        (STATUS, 5, 100.0, "repeat"),
        (STATUS, 6, 101.0, "new"),
        (STATUS, 4, 99.0, "old"),
        (POSITION, 4, 99.0, "new"),
        (STATUS, 6, 99.0, "new"),  # its clock was wrong before
    ],
)
def test_message_before_a_received_one_is_old(
    sender: MessageStream, channel: Channel, seq: int, mono_s: float, worth: str
) -> None:
    assert sender.accept(channel, header_of(seq, mono_s), NOW_NS) == worth


def test_clock_of_an_earlier_run_does_not_date_a_new_one(
    sender: MessageStream,
) -> None:
    """Monotonic time begins anew with it; its first alert overtook the first status."""
    assert sender.accept(EVENT, header_of(2, 2.0, boot_id=8), NOW_NS) == "new"
    assert sender.accept(STATUS, header_of(1, 1.0, boot_id=8), NOW_NS) == "new"


@pytest.mark.parametrize("channel", [STATUS, GPS])
def test_time_of_a_fix_does_not_change_the_units_clock(
    sender: MessageStream, channel: Channel
) -> None:
    """A receiver with a wrong time would move all messages of its unit."""
    [boot] = sender.boots
    before_ns = boot.offset_ns
    sender.accept(channel, header_of(6, 107.0), NOW_NS)
    assert boot.offset_ns - before_ns == (0 if channel is GPS else -7 * NS_PER_S)


def test_message_that_the_log_refused_is_missing(sender: MessageStream) -> None:
    assert [sender.has(7, seq) for seq in (4, 5)] == [False, True]
    sender.mark_missing(7, 5)
    sender.mark_missing(8, 5)  # of a run without received messages
    assert not sender.has(7, 5)
    assert not sender.has(8, 5)
    assert sender.accept_backfilled(7, 5) == "old"
    assert sender.accept_backfilled(7, 5) == "repeat"


def test_backfilled_runs_are_known_and_never_the_current_one(
    sender: MessageStream,
) -> None:
    for boot_id in range(100, 100 + 2 * BOOTS_KEPT):
        assert sender.accept_backfilled(boot_id, 1) == "old"
        assert sender.has(boot_id, 1)
    assert len(sender.boots) == BOOTS_KEPT
    assert sender.boots[-1].boot_id == 7


def test_backfilled_run_is_shown_once_it_comes_live(
    sender: MessageStream,
) -> None:
    """It began while its unit was still shown as connected, and was asked for its journal at
    once.
    """
    sender.accept_backfilled(8, 1)
    assert sender.accept(STATUS, header_of(2, 3.0, boot_id=8), NOW_NS + NS_PER_S) == "new"
    assert sender.boots[-1].boot_id == 8
    assert sender.accept(STATUS, header_of(6, 101.0), NOW_NS + 2 * NS_PER_S) == "old"


def test_message_overtaken_by_a_goodbye_does_not_undo_it(sender: MessageStream) -> None:
    """A goodbye is an alert, and overtakes earlier messages."""
    for seq, channel, goodbye in ((9, EVENT, True), (8, POSITION, False), (7, STATUS, False)):
        assert sender.accept(channel, header_of(seq, 100.0 + seq), NOW_NS) == "new"
        if goodbye:
            sender.stopped_ns = NOW_NS  # as ``units.apply_message`` does
    assert sender.stopped_ns == NOW_NS
    left = []
    for later in (header_of(10, 110.0), header_of(1, 1.0, boot_id=8)):
        sender.stopped_ns = NOW_NS
        sender.accept(STATUS, later, NOW_NS)
        left.append(sender.stopped_ns)
    assert left == [None, None]


def test_more_starts_in_a_minute_than_possible_are_not_accepted(
    sender: MessageStream,
) -> None:
    for number in range(1, STARTS_KEPT):
        assert not sender.is_restart_storm(100 + number, NOW_NS + number)
        sender.accept(STATUS, header_of(1, boot_id=100 + number), NOW_NS + number)
    soon_ns, later_ns = NOW_NS + RESTART_STORM_NS - 1, NOW_NS + RESTART_STORM_NS
    assert sender.is_restart_storm(200, soon_ns)
    assert not sender.is_restart_storm(101, soon_ns), "it has begun before"
    assert not sender.is_restart_storm(200, later_ns)
    sender.accept(STATUS, header_of(1, boot_id=200), later_ns)
    assert sender.is_restart_storm(201, later_ns), "the newest ones count"


@pytest.mark.parametrize(
    ("silent_s", "link"), [(9.9, "live"), (10.0, "stale"), (29.9, "stale"), (30.0, "lost")]
)
def test_silent_unit_is_stale_and_then_lost(
    sender: MessageStream, silent_s: float, link: str
) -> None:
    assert sender.link_at(NOW_NS + round(silent_s * NS_PER_S)) == link
    assert MessageStream("FF-02").link_at(NOW_NS) == "never"


def test_second_device_is_shown_when_the_first_has_been_silent(sender: MessageStream) -> None:
    """Until then its messages are kept, and change no shown state."""
    sender.accept(STATUS, header_of(1, 5.0, boot_id=8), NOW_NS)
    for second, worth in ((9.9, "old"), (10.0, "new"), (10.1, "new")):
        header = header_of(5 + round(10 * second), 100.0 + second)
        assert sender.accept(STATUS, header, NOW_NS + round(second * NS_PER_S)) == worth
    assert sender.boots[-1].boot_id == 7


def test_delayed_message_does_not_bring_back_the_run_before(sender: MessageStream) -> None:
    assert sender.accept(STATUS, header_of(1, 1.0, boot_id=8), NOW_NS + NS_PER_S) == "new"
    late_ns = NOW_NS + 60 * NS_PER_S
    assert sender.accept(STATUS, header_of(6, 101.0), late_ns) == "old"
    assert [boot.boot_id for boot in sender.boots] == [7, 8]


def test_newest_of_several_devices_under_one_name_is_shown(sender: MessageStream) -> None:
    for second in range(60):
        there = [7, *([8] if second < 30 else []), *([9] if second >= 20 else [])]
        for boot_id in there:
            header = header_of(10 + second, 100.0 + second, boot_id)
            sender.accept(STATUS, header, NOW_NS + second * NS_PER_S)
    assert sender.boots[-1].boot_id == 9
    assert sender.duplicate_device is not None
    assert sender.duplicate_device.boot_id == 7


def test_two_runs_at_once_for_five_seconds_are_two_devices(
    sender: MessageStream,
) -> None:
    for second, is_twin in ((0.0, False), (4.9, False), (5.0, True)):
        for boot_id in (7, 8):
            header = header_of(6 + round(10 * second), 100.0 + second, boot_id=boot_id)
            sender.accept(STATUS, header, NOW_NS + round(second * NS_PER_S))
        assert (sender.duplicate_device is not None) == is_twin


def test_unit_without_link_is_stale_until_its_next_message(sender: MessageStream) -> None:
    assert sender.link_at(NOW_NS + NS_PER_S) == "live"
    sender.is_unlinked = True
    assert sender.link_at(NOW_NS + NS_PER_S) == "stale"
    assert sender.link_at(NOW_NS + 30 * NS_PER_S) == "lost"
    sender.accept(STATUS, header_of(6, 101.0), NOW_NS + 2 * NS_PER_S)
    assert sender.link_at(NOW_NS + 3 * NS_PER_S) == "live"
