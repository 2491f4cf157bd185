"""The typed view of every message: SI units, frozen, with ``to_wire`` and ``from_wire``."""

from __future__ import annotations

from shared.messages.alarm import AlarmChange, AlarmParameters, AlarmState
from shared.messages.command import (
    ANSWERED_BY_PRESS,
    ASKS_WEARER,
    LIGHT,
    OF_STATION,
    SOUND,
    Command,
    CommandKind,
    CommandReply,
    CommandState,
)
from shared.messages.event import EventKind, Heartbeat, UnitEvent
from shared.messages.external import ExternalKind, ExternalMarker, ExternalMarkers
from shared.messages.fused import FusedPosition
from shared.messages.gps import FixType, GpsFix
from shared.messages.header import SCHEMA_REVISION, STATION_ID, Header
from shared.messages.imu import RawImu
from shared.messages.journal import JournalBoot, JournalChunk, JournalEntry, JournalIndex
from shared.messages.position import MagneticNorth, Position
from shared.messages.sighting import Sighting, SightingKind
from shared.messages.station import OperatorAction, Tick
from shared.messages.status import Activity, BatteryState, BodyPosture, Mobility, Status
from shared.messages.temperature import SensorTemperature, Temperature
from shared.messages.unit_description import (
    PreflightFinding,
    PreflightLevel,
    UnitDescription,
    UnitSensor,
)

Message = (
    Position
    | Status
    | Temperature
    | UnitDescription
    | RawImu
    | GpsFix
    | Sighting
    | UnitEvent
    | Heartbeat
    | Command
    | CommandReply
    | FusedPosition
    | AlarmChange
    | OperatorAction
    | Tick
    | ExternalMarkers
)

__all__ = [
    "ANSWERED_BY_PRESS",
    "ASKS_WEARER",
    "LIGHT",
    "OF_STATION",
    "SCHEMA_REVISION",
    "SOUND",
    "STATION_ID",
    "Activity",
    "AlarmChange",
    "AlarmParameters",
    "AlarmState",
    "BatteryState",
    "BodyPosture",
    "Command",
    "CommandKind",
    "CommandReply",
    "CommandState",
    "EventKind",
    "ExternalKind",
    "ExternalMarker",
    "ExternalMarkers",
    "FixType",
    "FusedPosition",
    "GpsFix",
    "Header",
    "Heartbeat",
    "JournalBoot",
    "JournalChunk",
    "JournalEntry",
    "JournalIndex",
    "MagneticNorth",
    "Message",
    "Mobility",
    "OperatorAction",
    "Position",
    "PreflightFinding",
    "PreflightLevel",
    "RawImu",
    "SensorTemperature",
    "Sighting",
    "SightingKind",
    "Status",
    "Temperature",
    "Tick",
    "UnitDescription",
    "UnitEvent",
    "UnitSensor",
]
