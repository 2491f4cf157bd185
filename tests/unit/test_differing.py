"""A log of a station that decided otherwise is told from one that did not."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import msgspec
import pytest

from base_station.events import event_of
from base_station.past.differing import shows_otherwise
from base_station.past.playback import Decision, Record
from shared.channels import channel_of
from shared.codec import encode
from shared.messages import STATION_ID, AlarmChange, FusedPosition
from tests.live_station import make_pipeline
from tests.logged_walk import walk_with_mayday

Change = Callable[[Decision], Decision]


def logged(change: Change = lambda decision: decision) -> Iterator[Record]:
    """What was decided stands behind what it comes of."""
    pipeline = make_pipeline()
    for t_ns, key, payload in walk_with_mayday():
        yield t_ns, key, payload
        for output in pipeline.step(event_of(t_ns, key, payload)):
            if isinstance(output, Decision):
                said = change(output)
                yield t_ns, channel_of(said).key(STATION_ID), encode(said)


def north(by_m: float) -> Change:
    def move(decision: Decision) -> Decision:
        if isinstance(decision, FusedPosition) and decision.north_m > 50.0:
            return msgspec.structs.replace(decision, north_m=decision.north_m + by_m)
        return decision

    return move


def named(decision: Decision) -> Decision:
    if isinstance(decision, AlarmChange):
        return msgspec.structs.replace(decision, alarm_id="another")
    return decision


def test_what_the_same_program_decided_is_shown_again() -> None:
    assert any(key.endswith("fused") for _, key, _ in logged())
    assert not shows_otherwise(logged(), make_pipeline())
    assert not shows_otherwise(walk_with_mayday(), make_pipeline()), "nothing was decided"
    assert not shows_otherwise(logged(north(0.01)), make_pipeline()), "nobody sees that"


@pytest.mark.parametrize("change", [north(2.0), named])
def test_what_another_program_decided_is_not(change: Change) -> None:
    assert shows_otherwise(logged(change), make_pipeline())
