"""What a unit's own words change in what is known of it, where nothing else has to be asked."""

from __future__ import annotations

from base_station.boot_state import captured_ns
from base_station.live_state import Fault, UnitState
from base_station.thermal import dose_of
from shared.clock import NS_PER_S
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

LONGEST_DOSE_STEP_S = 10.0  # of silence that still counts as being as hot as before


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
    if position.quality is Quality.GOOD:
        unit.degraded_since_ns = None
    elif unit.degraded_since_ns is None:
        unit.degraded_since_ns = t_ns


def _note_status(unit: UnitState, status: Status, t_ns: int) -> None:
    unit.status, unit.status_ns = status, t_ns
    pressed_ns = _pressed_ns(unit)
    if status.mayday and pressed_ns is None:  # the press itself may have been lost on the way
        unit.mayday_ns = t_ns
    elif pressed_ns is not None and not status.mayday:
        unit.mayday_cancelled_ns = t_ns


def _pressed_ns(unit: UnitState) -> int | None:
    """Since when there is a mayday that was not taken back."""
    cancelled_ns = unit.mayday_cancelled_ns
    if unit.mayday_ns is None or (cancelled_ns is not None and cancelled_ns >= unit.mayday_ns):
        return None
    return unit.mayday_ns


def _note_temperature(unit: UnitState, temperature: Temperature, t_ns: int) -> None:
    before = unit.temperature
    if before is not None and before.header.boot_id == temperature.header.boot_id:
        elapsed_s = (temperature.header.t_mono_ns - before.header.t_mono_ns) / NS_PER_S
        told_s = min(max(elapsed_s, 0.0), LONGEST_DOSE_STEP_S)  # its clock may be set back
        silent_s = max(elapsed_s - LONGEST_DOSE_STEP_S, 0.0)
        # Nobody knows of the rest of a silence, but that it was hot before it and after it.
        cooler_degc = min(before.ambient_degc, temperature.ambient_degc)
        unit.heat_dose += dose_of(before.ambient_degc, told_s) + dose_of(cooler_degc, silent_s)
    unit.temperature, unit.temperature_ns = temperature, t_ns


def _note_event(unit: UnitState, event: UnitEvent, t_ns: int) -> None:
    match event.kind:
        case EventKind.MAYDAY:
            said_ns = captured_ns(unit.boots, event.header, t_ns) or t_ns
            pressed_ns = _pressed_ns(unit)
            if pressed_ns is None or said_ns > pressed_ns:  # else a status has told it before
                unit.mayday_ns = t_ns
        case EventKind.MAYDAY_CANCELLED:
            unit.mayday_cancelled_ns = t_ns
        case EventKind.FALL:
            unit.fall_ns = t_ns
        case EventKind.SENSOR_FAULT | EventKind.STORAGE_FAULT:
            said = event.detail or event.kind.name.lower().replace("_", " ")
            unit.fault = Fault(t_ns, said)
        case EventKind.STOPPED | EventKind.SOURCE_ENDED:
            if _is_last_word(unit, event.header):  # it may come out of the journal of a run before
                unit.stopped_ns = t_ns
        case _:
            pass


def _is_last_word(unit: UnitState, header: Header) -> bool:
    running = unit.boots[-1]
    return header.boot_id == running.boot_id and header.seq >= running.seen.lasts[-1]
