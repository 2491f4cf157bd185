"""Progress of a mayday, with the notices to its wearer."""

from __future__ import annotations

import pytest

from edge.agent.mayday_progress import MaydayProgress
from shared.messages import Command, CommandKind, EventKind, Header, UnitEvent

BOOT = 5


def event(kind: EventKind, seq: int) -> UnitEvent:
    return UnitEvent(Header("u1", BOOT, seq, 0), kind, "button")


def acknowledgement(seq: int, boot_id: int = BOOT) -> Command:
    return Command(
        Header("station", 1, 1, 0), "m1", CommandKind.MAYDAY_ACKNOWLEDGED, "ada", 0,
        mayday_boot_id=boot_id, mayday_seq=seq,
    )  # fmt: skip


def test_each_mayday_is_received_once() -> None:
    progress = MaydayProgress()
    progress.note_own([event(EventKind.MAYDAY, 7)])
    progress.note_received(6)
    assert (progress.called, progress.received) == (1, 0)
    progress.note_received(7)
    progress.note_received(8)
    assert (progress.called, progress.received) == (1, 1)


@pytest.mark.parametrize(
    ("boot_id", "seq", "is_of_it"),
    [(BOOT, 7, True), (BOOT, 20, True), (BOOT, 6, False), (4, 7, False)],
)
def test_acknowledgement_belongs_to_the_newest_mayday_or_to_none(
    boot_id: int, seq: int, is_of_it: bool
) -> None:
    progress = MaydayProgress()
    assert not progress.is_acknowledged_by(acknowledgement(seq, boot_id)), "nobody has called"
    progress.note_own([event(EventKind.MAYDAY, 3), event(EventKind.MAYDAY, 7)])
    assert progress.is_acknowledged_by(acknowledgement(seq, boot_id)) is is_of_it
    progress.note_own([event(EventKind.MAYDAY_CANCELLED, 8)])
    assert not progress.is_acknowledged_by(acknowledgement(seq, boot_id))


@pytest.mark.parametrize("kind", [EventKind.MAYDAY, EventKind.MAYDAY_CANCELLED])
def test_another_mayday_and_its_end_are_not_acknowledged_by_the_one_before(kind: EventKind) -> None:
    progress = MaydayProgress()
    progress.note_own([event(EventKind.MAYDAY, 7)])
    progress.note_acknowledged("m1")
    progress.note_own([event(EventKind.FALL, 8)])
    assert progress.acknowledgement == "m1"
    progress.note_own([event(kind, 9)])
    assert progress.acknowledgement == ""
