"""A replay solves pins as the live station did, to the last bit."""

from __future__ import annotations

from base_station.replay.playback import compare
from shared.channels import channel_of
from shared.codec import encode
from shared.messages import STATION_ID, AlarmChange, FusedPosition, Sighting, SightingKind
from shared.messages.pins import PlaceBeacon, RemovePin, SetMeeting
from tests.rig.live_station import make_pipeline
from tests.rig.round_walk import Walk
from tests.rig.station_script import Record, Script


def reported() -> Walk:
    """Pins of every kind, one of them wrong, one removed, while two people walk."""
    walk = Walk("FF-01", "FF-02", turn_rad=0.4)
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(120)
    walk.pin("p1", "FF-01", 100.0)
    walk.pin("bad", "FF-01", 110.0, off_m=90.0)
    walk.go(30)
    walk.script.act(SetMeeting("m", "FF-01", "FF-02", walk.script.t_ns, 1.0, ""))
    walk.script.act(PlaceBeacon("b1", "door", 20.0, 0.0, None, 0.3, 3.0))
    walk.go(30)
    walk.script.say(Sighting(walk.script.header("FF-02"), SightingKind.BEACON, "b1", 2.0))
    walk.go(20)
    walk.script.act(RemovePin("p1"))
    walk.go(20)
    return walk


def logged(walk: Walk) -> list[Record]:
    """The records as a live station would have logged them, decisions included."""
    again = Script(make_pipeline())
    records: list[Record] = []
    for t_ns, key, payload in walk.script.records:
        again.now_s = (t_ns - walk.script.records[0][0]) / 1e9
        records.append((t_ns, key, payload))
        for output in again.record(key, payload):
            if isinstance(output, AlarmChange | FusedPosition):
                decided = channel_of(output).key(STATION_ID)
                records.append((output.header.t_utc_ns, decided, encode(output)))
    return records


def test_replay_of_pins_makes_the_same_decisions() -> None:
    walk = reported()
    state = walk.script.pipeline.state
    assert {pin_id: one.state for pin_id, one in state.site.pin_verdicts.items()}[
        "bad"
    ] == "conflict"
    assert {pin.kind for pin in state.site.pins.values()} == {"place", "meeting", "beacon"}
    assert list(compare(logged(walk), make_pipeline())) == []
