"""Projections of a short incident: two units, one wearer, one alarm, two positions."""

from __future__ import annotations

from base_station.storage.projection import Projection
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import AlarmChange, AlarmState, FusedPosition, Header, OperatorAction
from shared.messages.station import (
    Action,
    Assign,
    CloseIncident,
    OpenIncident,
    RegisterUnit,
    Unassign,
)
from tests.rig import message_factory


def header(t_s: float) -> Header:
    t_ns = round(t_s * NS_PER_S)
    return Header("station", 1, 1, t_ns, t_utc_ns=t_ns)


def alarm(t_s: float, state: AlarmState, by: str = "") -> AlarmChange:
    return AlarmChange(
        header(t_s), "heat:FF-01:5", "heat", "FF-01", 1, state, "critical", "hot", by,
        5 * NS_PER_S, 5 * NS_PER_S,
    )  # fmt: skip


def fused(t_s: float, north_m: float) -> FusedPosition:
    return message_factory.fused(header(t_s), "FF-01", north_m=north_m)


def acted(t_s: float, *actions: Action) -> Projection:
    header_factory = HeaderFactory("station", round(t_s), ManualClock())
    return Projection(
        round(t_s * NS_PER_S),
        actions=tuple(
            OperatorAction(header(t_s), f"{t_s}-{header_factory.header().seq}", "mia", action)
            for action in actions
        ),
    )


STORY = (
    acted(1, RegisterUnit("FF-01", "one"), RegisterUnit("FF-02", "two")),
    acted(2, OpenIncident("i-1", "Kitchen")),
    acted(3, Assign("FF-01", "p-1", "Ada", "A", "")),
    Projection(5 * NS_PER_S, alarms=(alarm(5, AlarmState.RAISED),), last_messages=(("FF-01", 5),)),
    Projection(
        6 * NS_PER_S, tracks=(fused(5.2, 1.0), fused(6.2, 2.0)), last_messages=(("FF-03", 6),)
    ),
    acted(7, Assign("FF-02", "p-1", "Ada", "A", "")),
    Projection(8 * NS_PER_S, alarms=(alarm(8, AlarmState.ACKNOWLEDGED, "mia"),)),
    acted(9, Unassign("FF-02")),
    acted(10, CloseIncident("i-1")),
)
