"""A mayday outlives the unit's sudden end, and only that."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from edge.last_words import mayday_before
from edge.pipeline import TrackerPipeline, UnitIdentity
from edge.samples import SensorDescription
from edge.spool import Journaled, Spool
from edge.tracker import make_tracker
from shared.channels import EVENT
from shared.clock import ManualClock
from shared.codec import encode
from shared.envelope import Stamper
from shared.messages import EventKind, UnitEvent

STARTED, STOPPED = EventKind.STARTED, EventKind.STOPPED
MAYDAY, CANCELLED, FALL = EventKind.MAYDAY, EventKind.MAYDAY_CANCELLED, EventKind.FALL
BOOTS = itertools.count(1)


def boot(path: Path, *kinds: EventKind) -> bool:
    """One boot that says these; whether it knew of a mayday when it began."""
    spool = Spool(path / "journal.sqlite", BOOTS.__next__, 0, 10**8)
    known = mayday_before(spool)
    stamper = Stamper("u1", spool.boot_id, ManualClock())
    events = [UnitEvent(stamper.header(), kind) for kind in kinds]
    spool.append([Journaled(e.header.seq, EVENT, 0, encode(e)) for e in events])
    spool.close()
    return known


@pytest.mark.parametrize(
    ("said", "latched"),
    [
        ((STARTED,), False),
        ((STARTED, MAYDAY), True),
        ((STARTED, MAYDAY, FALL), True),
        ((STARTED, MAYDAY, CANCELLED), False),
        ((STARTED, MAYDAY, CANCELLED, MAYDAY), True),
        ((STARTED, MAYDAY, STOPPED), False),
    ],
)
def test_what_the_last_boot_said_last_counts(tmp_path, said, latched):
    assert not boot(tmp_path, *said)
    assert boot(tmp_path, STARTED) is latched


def test_a_mayday_from_before_is_said_again_first_thing():
    sensor = SensorDescription("s", 100.0)
    pipeline = TrackerPipeline(
        UnitIdentity("", "", "eskf", sensor),
        make_tracker("eskf", sensor),
        Stamper("u1", 1, ManualClock()),
        5.0,
        mayday=True,
    )
    events = [message for message in pipeline.start() if isinstance(message, UnitEvent)]
    assert [event.kind for event in events] == [STARTED, MAYDAY]
