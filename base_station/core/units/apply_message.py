"""Application of a unit's message to its own state, where nothing else is needed."""

from __future__ import annotations

from base_station.core.state import Fault, UnitState
from base_station.core.state.boot_state import event_time_ns
from base_station.core.units import thermal_dose
from shared.messages import (
    EventKind,
    Header,
    Heartbeat,
    Message,
    Position,
    Status,
    Temperature,
    UnitDescription,
    UnitEvent,
)
from shared.quality import GOOD

_FAULTS = frozenset({EventKind.SENSOR_FAULT, EventKind.STORAGE_FAULT})


def apply(unit: UnitState, message: Message, t_ns: int) -> None:
    """Apply a message of a unit; ``t_ns`` is station time."""
    match message:
        case Position():
            _apply_position(unit, message, t_ns)
        case Status():
            _apply_status(unit, message, t_ns)
        case Temperature():
            _apply_temperature(unit, message, t_ns)
        case UnitDescription():
            unit.description = message
        case Heartbeat():
            unit.heartbeat = message
        case UnitEvent():
            _apply_event(unit, message, t_ns)
        case _:
            pass  # raw samples and heartbeats: only their arrival counts here


def _apply_position(unit: UnitState, position: Position, t_ns: int) -> None:
    unit.position, unit.position_ns = position, t_ns
    if position.path_quality is GOOD:
        unit.degraded_since_ns = None
    elif unit.degraded_since_ns is None:
        unit.degraded_since_ns = t_ns


def _apply_status(unit: UnitState, status: Status, t_ns: int) -> None:
    """Apply a status.  A mayday and its cancellation are alerts, which may arrive before earlier
    messages of the unit.
    """
    unit.status, unit.status_ns = status, t_ns
    mayday = unit.mayday
    if status.mayday == mayday.is_active:
        return
    event_ns = _event_time_ns(unit, status.header, t_ns) or t_ns
    if status.mayday and event_ns > mayday.cancelled_event_ns:  # the press itself may be lost
        mayday.press(status.header, t_ns, event_ns)
    elif not status.mayday and event_ns > mayday.event_ns:
        mayday.cancel(t_ns, event_ns)


def _apply_temperature(unit: UnitState, temperature: Temperature, t_ns: int) -> None:
    header = temperature.header
    heat = unit.heat
    heat.dose += thermal_dose.add_live(
        heat.exposures, header.boot_id, header.t_mono_ns, temperature.ambient_degc
    )
    heat.temperature, heat.temperature_ns = temperature, t_ns


def apply_late_temperature(
    unit: UnitState, temperature: Temperature, since_ns: int, t_ns: int
) -> None:
    """Apply a temperature from the journal: it changes only the dose, and that from ``since_ns``
    on.
    """
    header = temperature.header
    event_ns = event_time_ns(unit.boots, header, t_ns)
    if event_ns is None or event_ns < since_ns:
        return
    heat = unit.heat
    added = thermal_dose.add_late(
        heat.exposures, header.boot_id, header.t_mono_ns, temperature.ambient_degc
    )
    heat.dose += added
    heat.late_dose += added


def _apply_event(unit: UnitState, event: UnitEvent, t_ns: int) -> None:
    event_time_ns = _event_time_ns(unit, event.header, t_ns)
    is_dated, event_ns = event_time_ns is not None, event_time_ns or t_ns
    mayday = unit.mayday
    match event.kind:
        case EventKind.MAYDAY:
            # A status may have reported an active call before, where the radio lost the press.
            worn_from_ns = unit.wearer.from_ns(mayday.event_ns)
            stands = mayday.is_active and unit.wearer.from_ns(event_ns) == worn_from_ns
            if not stands or event_ns > mayday.event_ns:
                mayday.press(event.header, t_ns, event_ns, is_dated=is_dated)
        case EventKind.MAYDAY_CANCELLED:
            if event_ns >= mayday.event_ns:  # else it was pressed again since
                mayday.cancel(t_ns, event_ns)
        case EventKind.FALL:
            unit.fall.note(t_ns, event_ns, is_dated=is_dated)
        case EventKind.SENSOR_FAULT | EventKind.STORAGE_FAULT:
            apply_fault(unit, event, t_ns)
        case EventKind.STOPPED:
            # A failed unit is missing; the message may come from the journal of a run before.
            if event.is_stop_in_order and _is_last_message(unit, event.header):
                unit.stopped_ns = t_ns
        case _:
            pass


def apply_fault(unit: UnitState, event: UnitEvent, t_ns: int) -> None:
    """Record a fault that the unit reports; other events are ignored."""
    if event.kind in _FAULTS:
        text = event.detail or event.kind.name.lower().replace("_", " ")
        unit.fault = Fault(t_ns, text, event.text_code)


def _event_time_ns(unit: UnitState, header: Header, t_ns: int) -> int | None:
    """Station time at which the unit or its tracking agent sent a message; None: unknown."""
    agent = unit.tracker
    sender = agent if agent is not None and agent.unit_id == header.unit_id else unit
    return event_time_ns(sender.boots, header, t_ns)


def _is_last_message(unit: UnitState, header: Header) -> bool:
    running = unit.boots[-1]
    return header.boot_id == running.boot_id and header.seq >= running.seen.lasts[-1]
