"""Commands of the station itself to one unit, caused by actions of an operator."""

from __future__ import annotations

from base_station.core.state import StationState, UnitState
from base_station.core.state.command import Delivery, SentCommand
from shared.messages import CommandKind


def create(
    state: StationState,
    kind: CommandKind,
    by: str,
    unit: UnitState,
    lasts_ns: int,
    incident_id: str,
    *,
    mayday_boot_id: int = 0,
    mayday_seq: int = 0,
    alarm_id: str = "",
) -> SentCommand:
    """Create a command to one unit, with its subject; its id is the same in a replay."""
    command = SentCommand(
        command_id=f"{_PREFIXES[kind]}-{unit.unit_id}-{state.t_ns}",
        kind=kind,
        text="",
        position_rate_hz=0.0,
        issued_by=by,
        issued_ns=state.t_ns,
        expires_ns=state.t_ns + lasts_ns,
        deliveries={unit.unit_id: Delivery(unit.unit_id, can_be_notified=unit.can_be_notified)},
        incident_id=incident_id,
        mayday_boot_id=mayday_boot_id,
        mayday_seq=mayday_seq,
        alarm_id=alarm_id,
    )
    state.commands[command.command_id] = command
    return command


_PREFIXES = {CommandKind.MAYDAY_ACKNOWLEDGED: "mayday", CommandKind.ALARM_ACKNOWLEDGED: "alarm"}
