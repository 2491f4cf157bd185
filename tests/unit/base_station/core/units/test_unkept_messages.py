"""Messages that units could not keep are among the station's problems."""

from __future__ import annotations

from base_station.views.station import StationFacts, health_view
from shared.channels import HEARTBEAT
from shared.codec import decode, encode
from shared.messages import Heartbeat
from tests.rig.station_script import Script

U = "FF-01"


def test_unkept_messages_of_a_unit_are_a_problem() -> None:
    script = Script()

    def problems() -> str:
        return " ".join(health_view(script.pipeline.state, StationFacts()).problems)

    script.say(Heartbeat(script.header(U), 1, 1))
    assert "journal" not in problems()
    script.say(Heartbeat(script.header(U), 1, 1, never_saved=120, given_up=3))
    assert f"{U} 123" in problems()
    script.say(Heartbeat(script.header(U), 1, 1))  # restarted, with room
    assert "journal" not in problems()


def test_heartbeat_carries_the_unkept_messages() -> None:
    script = Script()
    beat = Heartbeat(script.header(U), 5, 9, never_saved=2**40, given_up=7)
    received = decode(HEARTBEAT, encode(beat))
    assert isinstance(received, Heartbeat)
    assert (received.never_saved, received.given_up) == (2**40, 7)
