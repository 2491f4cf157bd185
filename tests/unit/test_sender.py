"""Which messages of one sender are there, and which of them say how it is now."""

from __future__ import annotations

import pytest

from base_station.sender import BOOTS, Sender
from shared.channels import EVENT, POSITION, STATUS, Channel
from shared.clock import NS_PER_S
from shared.messages import Header

NOW_NS = 1_700_000_000 * NS_PER_S


def said(seq: int, mono_s: float = 100.0, boot_id: int = 7) -> Header:
    return Header("FF-01", boot_id, seq, round(mono_s * NS_PER_S))


@pytest.fixture
def sender() -> Sender:
    """The fifth message of its run came, of its hundredth second."""
    sender = Sender("FF-01")
    assert sender.accept(STATUS, said(5), NOW_NS) == "new"
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
def test_what_is_said_before_what_came_already_is_old(
    sender: Sender, channel: Channel, seq: int, mono_s: float, worth: str
) -> None:
    assert sender.accept(channel, said(seq, mono_s), NOW_NS) == worth


def test_what_the_log_did_not_take_is_missing_like_what_never_came(sender: Sender) -> None:
    assert [sender.has(7, seq) for seq in (4, 5)] == [False, True]
    sender.take_back(7, 5)
    sender.take_back(8, 5)  # of a run of which nothing came
    assert not sender.has(7, 5)
    assert not sender.has(8, 5)
    assert sender.recall(7, 5) == "old"
    assert sender.recall(7, 5) == "repeat"


def test_runs_out_of_the_journal_are_known_and_never_the_one_that_runs(sender: Sender) -> None:
    for boot_id in range(100, 100 + 2 * BOOTS):
        assert sender.recall(boot_id, 1) == "old"
        assert sender.has(boot_id, 1)
    assert len(sender.boots) == BOOTS
    assert sender.boots[-1].boot_id == 7


def test_a_run_of_which_the_journal_told_first_is_shown_as_soon_as_it_is_heard(
    sender: Sender,
) -> None:
    """It began while its unit was still taken for there, and was asked for what it has at once."""
    sender.recall(8, 1)
    assert sender.accept(STATUS, said(2, 3.0, boot_id=8), NOW_NS + NS_PER_S) == "new"
    assert sender.boots[-1].boot_id == 8
    assert sender.accept(STATUS, said(6, 101.0), NOW_NS + 2 * NS_PER_S) == "old"


def test_what_a_goodbye_overtook_does_not_take_it_back(sender: Sender) -> None:
    """It is an alert, and goes ahead of what was said before it."""
    for seq, channel, goodbye in ((9, EVENT, True), (8, POSITION, False), (7, STATUS, False)):
        assert sender.accept(channel, said(seq, 100.0 + seq), NOW_NS) == "new"
        if goodbye:
            sender.stopped_ns = NOW_NS  # as ``noting`` does
    assert sender.stopped_ns == NOW_NS
    left = []
    for later in (said(10, 110.0), said(1, 1.0, boot_id=8)):
        sender.stopped_ns = NOW_NS
        sender.accept(STATUS, later, NOW_NS)
        left.append(sender.stopped_ns)
    assert left == [None, None]
