"""People on duty, and what is asked of them: for tests of the roll call, of work and rest."""

from __future__ import annotations

from base_station.core.events import Refused
from base_station.core.state import UnitState
from base_station.core.state.duty import Duty
from shared.clock import NS_PER_S
from shared.messages import (
    AlarmChange,
    CommandKind,
    CommandReply,
    CommandState,
)
from shared.messages.station import (
    Assign,
    OpenIncident,
    SendCommand,
)
from tests.rig.station_script import Script

INTERVAL_S = 60.0


def at_work() -> Script:
    """Two of a red crew and one of a blue one, in an open incident."""
    script = Script()
    script.register("FF-01", "FF-02", "FF-03")
    for number, crew in ((1, "red"), (2, "red"), (3, "blue")):
        script.act(Assign(f"FF-0{number}", f"p{number}", f"Person {number}", crew, ""))
    script.act(OpenIncident("i1", "Mill Lane", INTERVAL_S, 120.0))
    return script


def unit(script: Script, unit_id: str = "FF-01") -> UnitState:
    return script.pipeline.state.units[unit_id]


def duty(script: Script, unit_id: str = "FF-01") -> Duty:
    found = unit(script, unit_id).duty
    assert found is not None
    return found


def confirmed(script: Script, unit_id: str = "FF-01") -> tuple[str, str]:
    """Kind and user of the last PAR confirmation."""
    last = duty(script, unit_id).confirmation
    assert last is not None
    return last.source, last.by


def left_s(script: Script, unit_id: str = "FF-01") -> float:
    return (duty(script, unit_id).due_ns - script.t_ns) / NS_PER_S


def rest_left_s(script: Script) -> float:
    due_ns = duty(script).rest_due_ns
    assert due_ns is not None
    return (due_ns - script.t_ns) / NS_PER_S


def overdue(script: Script) -> list[AlarmChange]:
    return [alarm for alarm in script.alarms if alarm.rule == "missed-check-in"]


def rest_alarms(script: Script) -> list[AlarmChange]:
    return [alarm for alarm in script.alarms if alarm.rule == "rest-due"]


def refusals(script: Script) -> list[str]:
    return [output.reason for output in script.outputs if isinstance(output, Refused)]


def order(script: Script, kind: CommandKind, command_id: str = "c1") -> None:
    script.act(SendCommand(command_id, kind, "", "", True, "", 0.0, lasts_s=600.0))


def answer(script: Script, captured_s: float) -> None:
    """The wearer's press, out of the journal of a unit whose clock is known."""
    header = script.header("FF-01", captured_s)
    script.say(CommandReply(header, "c1", CommandState.ACKNOWLEDGED, ""))
