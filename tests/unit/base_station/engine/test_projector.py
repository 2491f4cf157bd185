"""Projection of the station's decisions and people's actions into the tables."""

from __future__ import annotations

import pytest

from base_station.core.events import Output, Received, Refused, UnitChanged
from base_station.engine.projector import LAST_MESSAGE_STEP_NS, Projector
from shared.channels import tracker_id
from shared.clock import NS_PER_S
from shared.messages import STATION_ID, Header, OperatorAction, Temperature
from shared.messages.station import OpenIncident

T_NS = 1_700_000_000 * NS_PER_S


@pytest.mark.parametrize("is_refused", [False, True])
def test_refused_action_is_not_in_the_tables(is_refused: bool) -> None:
    """They would have a second incident open beside the real one."""
    projector = Projector()
    action = OperatorAction(Header(STATION_ID, 1, 1, 1), "a1", "ada", OpenIncident("i2", "Mill"))
    outputs: list[Output] = [Refused("a1", "an incident is open already")] if is_refused else []
    projector.note(Received(T_NS, STATION_ID, action), outputs)
    projection = projector.take(T_NS)
    assert projector.is_urgent is False
    if is_refused:
        assert projection is None
    else:
        assert projection is not None
        assert [one.action for one in projection.actions] == [action.action]
        assert projection.actions[0].header.t_utc_ns == T_NS


def test_time_of_the_last_message_is_projected_in_steps() -> None:
    projector = Projector()
    projected_ns = []
    for second in range(12):
        t_ns = T_NS + second * NS_PER_S
        message = Temperature(Header("FF-01", 7, second + 1, t_ns), 20.0)
        projector.note(Received(t_ns, "FF-01", message), [UnitChanged("FF-01")])
        if (projection := projector.take(t_ns)) is not None:
            projected_ns += [t_ns for _, t_ns in projection.last_messages]
    assert projected_ns == [T_NS, T_NS + LAST_MESSAGE_STEP_NS, T_NS + 2 * LAST_MESSAGE_STEP_NS]


def test_tracking_agent_is_no_unit() -> None:
    projector = Projector()
    agent = tracker_id("FF-01")
    message = Temperature(Header(agent, 7, 1, T_NS), 20.0)
    projector.note(Received(T_NS, agent, message), [UnitChanged("FF-01")])
    assert projector.take(T_NS) is None
