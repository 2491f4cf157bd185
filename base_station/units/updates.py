"""What a unit's own words change in what is known of it, where nothing else has to be asked."""

from __future__ import annotations

from base_station.live_state import Fault, UnitState
from base_station.units import heat_told
from base_station.units.boot_state import told_ns
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
from shared.quality import Quality

_FAULTS = frozenset({EventKind.SENSOR_FAULT, EventKind.STORAGE_FAULT})


def note(unit: UnitState, message: Message, t_ns: int) -> None:
    """A unit said this; ``t_ns`` is station time."""
    match message:
        case Position():
            _note_position(unit, message, t_ns)
        case Status():
            _note_status(unit, message, t_ns)
        case Temperature():
            _note_temperature(unit, message, t_ns)
        case UnitDescription():
            unit.description = message
        case Heartbeat():
            unit.heartbeat = message
        case UnitEvent():
            _note_event(unit, message, t_ns)
        case _:
            pass  # raw samples and signs of life: that they came is all that counts here


def _note_position(unit: UnitState, position: Position, t_ns: int) -> None:
    unit.position, unit.position_ns = position, t_ns
    if position.path_quality is Quality.GOOD:
        unit.degraded_since_ns = None
    elif unit.degraded_since_ns is None:
        unit.degraded_since_ns = t_ns


def _note_status(unit: UnitState, status: Status, t_ns: int) -> None:
    """A press and its taking back are alerts, which overtake what the unit said before them."""
    unit.status, unit.status_ns = status, t_ns
    if status.mayday == _is_pressed(unit):
        return
    said_ns = _told_ns(unit, status.header, t_ns) or t_ns
    if status.mayday and said_ns > unit.mayday_cancelled_said_ns:  # the press itself may be lost
        _press(unit, t_ns, said_ns)
    elif not status.mayday and said_ns > unit.mayday_said_ns:
        unit.mayday_cancelled_ns, unit.mayday_cancelled_said_ns = t_ns, said_ns


def _press(unit: UnitState, t_ns: int, said_ns: int, is_dated: bool = True) -> None:
    unit.mayday_ns, unit.mayday_said_ns, unit.mayday_is_dated = t_ns, said_ns, is_dated
    unit.mayday_cancelled_ns = None


def _is_pressed(unit: UnitState) -> bool:
    """Whether a mayday was told that was not taken back."""
    return unit.mayday_ns is not None and unit.mayday_cancelled_ns is None


def _note_temperature(unit: UnitState, temperature: Temperature, t_ns: int) -> None:
    header = temperature.header
    unit.heat_dose += heat_told.follow(
        unit.heat_told, header.boot_id, header.t_mono_ns, temperature.ambient_degc
    )
    unit.temperature, unit.temperature_ns = temperature, t_ns


def note_late_temperature(
    unit: UnitState, temperature: Temperature, since_ns: int, t_ns: int
) -> None:
    """Out of the journal: it says nothing of now, and what the equipment took at its time counts
    from ``since_ns`` on.
    """
    header = temperature.header
    said_ns = told_ns(unit.boots, header, t_ns)
    if said_ns is None or said_ns < since_ns:
        return
    added = heat_told.fill(
        unit.heat_told, header.boot_id, header.t_mono_ns, temperature.ambient_degc
    )
    unit.heat_dose += added
    unit.late_heat_dose += added


def _note_event(unit: UnitState, event: UnitEvent, t_ns: int) -> None:
    told_ns = _told_ns(unit, event.header, t_ns)
    is_dated, said_ns = told_ns is not None, told_ns or t_ns
    match event.kind:
        case EventKind.MAYDAY:
            # Of one that stands a status may have told before, where the radio lost the press.
            stands = _is_pressed(unit) and unit.worn_from_ns(said_ns) == unit.worn_from_ns(
                unit.mayday_said_ns
            )
            if not stands or said_ns > unit.mayday_said_ns:
                _press(unit, t_ns, said_ns, is_dated)
        case EventKind.MAYDAY_CANCELLED:
            if said_ns >= unit.mayday_said_ns:  # else it was pressed again since
                unit.mayday_cancelled_ns, unit.mayday_cancelled_said_ns = t_ns, said_ns
        case EventKind.FALL:
            unit.fall_ns, unit.fall_said_ns, unit.fall_is_dated = t_ns, said_ns, is_dated
        case EventKind.SENSOR_FAULT | EventKind.STORAGE_FAULT:
            note_fault(unit, event, t_ns)
        case EventKind.STOPPED:
            # One that has failed is missing; and it may come out of the journal of a run before.
            if event.is_stop_in_order and _is_last_word(unit, event.header):
                unit.stopped_ns = t_ns
        case _:
            pass


def note_fault(unit: UnitState, event: UnitEvent, t_ns: int) -> None:
    """It says that something of its own fails; other events are left alone."""
    if event.kind in _FAULTS:
        unit.fault = Fault(t_ns, event.detail or event.kind.name.lower().replace("_", " "))


def _told_ns(unit: UnitState, header: Header, t_ns: int) -> int | None:
    """When it or its tracking agent said a message; None: nobody can tell."""
    agent = unit.tracker
    sender = agent if agent is not None and agent.unit_id == header.unit_id else unit
    return told_ns(sender.boots, header, t_ns)


def _is_last_word(unit: UnitState, header: Header) -> bool:
    running = unit.boots[-1]
    return header.boot_id == running.boot_id and header.seq >= running.seen.lasts[-1]
