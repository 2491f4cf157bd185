"""Walk of two people with pins of every kind."""

from __future__ import annotations

from shared.messages import Sighting, SightingKind
from shared.messages.pins import PlaceBeacon, RemovePin, SetMeeting
from tests.rig.round_walk import Walk


def pinned_walk() -> Walk:
    """Return the walk; one pin is wrong, and one was removed."""
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
