"""Notification of wearers on cards and commands."""

from __future__ import annotations

import pytest

from base_station.storage.db.known_people import person_lookup
from base_station.views.station import command_view
from base_station.views.units import unit_views
from shared.messages import CommandKind, CommandState
from shared.messages.station import SendCommand
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"


def sent(
    kind: CommandKind = CommandKind.EVACUATE, outputs: tuple[str, ...] | None = None
) -> Script:
    """A command to one unit, which has described its outputs where ``outputs`` are given."""
    script = Script()
    script.register(U)
    if outputs is not None:
        script.say(message_factory.description(script.header(U), outputs=outputs))
    script.act(SendCommand("c1", kind, U, "", False, "hi", 5.0, 60.0))
    return script


@pytest.mark.parametrize(
    ("outputs", "shown"), [(None, None), ((), False), (("speech",), True)]
)  # fmt: skip
def test_card_and_command_show_whether_the_unit_can_notify(
    outputs: tuple[str, ...] | None, shown: bool | None
) -> None:
    script = sent(outputs=outputs)
    live = script.pipeline.state
    (card,) = unit_views(live, [live.units[U]], person_lookup({}))
    assert card.can_be_notified is shown
    view = command_view(live.commands["c1"], person_lookup({}))
    assert view.notifies_wearer
    assert [one.can_be_notified for one in view.units] == [shown]


def test_command_shows_when_the_wearer_was_notified() -> None:
    script = sent(CommandKind.LOCATE, ("led",))
    script.now_s += 1.0
    script.reply(U, "c1", CommandState.NOTIFIED)
    (one,) = command_view(script.pipeline.state.commands["c1"], person_lookup({})).units
    assert (one.state, one.notified_ms) == ("notified", script.t_ns // 10**6)
    rate = sent(CommandKind.SET_POSITION_RATE).pipeline.state.commands["c1"]
    assert not command_view(rate, person_lookup({})).notifies_wearer
