"""Walk of two people with pins of every kind."""

from __future__ import annotations

from shared.messages import Sighting, SightingKind
from shared.messages.pins import PlaceBeacon, RemovePin, SetMeeting
from tests.rig.round_walk import Walk


def pinned_walk(first_s: int = 120, between_s: int = 30, after_s: int = 20) -> Walk:
    """Return the walk; one pin is wrong, and one was removed.

    The members walk for ``first_s`` until the pins, for ``between_s`` before and after they meet,
    and for ``after_s`` after a beacon was noticed and after a pin was removed.
    """
    walk = Walk("FF-01", "FF-02", turn_rad=0.4)
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(first_s)
    walk.pin("p1", "FF-01", first_s - 20.0)
    walk.pin("bad", "FF-01", first_s - 10.0, off_m=90.0)
    walk.go(between_s)
    walk.script.act(SetMeeting("m", "FF-01", "FF-02", walk.script.t_ns, 1.0, ""))
    walk.script.act(PlaceBeacon("b1", "door", 20.0, 0.0, None, 0.3, 3.0))
    walk.go(between_s)
    walk.script.say(Sighting(walk.script.header("FF-02"), SightingKind.BEACON, "b1", 2.0))
    walk.go(after_s)
    walk.script.act(RemovePin("p1"))
    walk.go(after_s)
    return walk
