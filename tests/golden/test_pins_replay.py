"""A replay solves pins as the live station did, to the last bit."""

from __future__ import annotations

from base_station.replay.playback import compare
from tests.rig.live_station import make_pipeline
from tests.rig.logged_script import logged
from tests.rig.pinned_walk import pinned_walk


def test_replay_of_pins_makes_the_same_decisions() -> None:
    walk = pinned_walk()
    state = walk.script.pipeline.state
    assert {pin_id: one.state for pin_id, one in state.site.pin_verdicts.items()}[
        "bad"
    ] == "conflict"
    assert {pin.kind for pin in state.site.pins.values()} == {"place", "meeting", "beacon"}
    assert list(compare(logged(walk.script), make_pipeline())) == []
