"""Time and people as events: what steps the station's pipeline beside the units' messages."""

from __future__ import annotations

from shared.messages.station.alarm_actions import AcknowledgeAlarm, ResolveAlarm, SetThresholds
from shared.messages.station.command_actions import (
    CheckIn,
    ConfirmCommand,
    SendCommand,
    SetAccountability,
    UndoConfirmation,
)
from shared.messages.station.incident_actions import (
    AssignIncident,
    CloseIncident,
    DismissDispatch,
    ImportFile,
    NoteDispatch,
    OpenIncident,
    RemoveImport,
)
from shared.messages.station.operator_action import Action, OperatorAction
from shared.messages.station.site_actions import (
    SetAnchor,
    SetFuser,
    SetPlan,
    SetReference,
    SetStart,
)
from shared.messages.station.station_actions import DoneApart, ReportProblem, TakeOver
from shared.messages.station.tick import Tick
from shared.messages.station.unit_actions import (
    Assign,
    BeginErasure,
    ForgetWearers,
    RegisterUnit,
    SetRest,
    Unassign,
)

__all__ = [
    "AcknowledgeAlarm",
    "Action",
    "Assign",
    "AssignIncident",
    "BeginErasure",
    "CheckIn",
    "CloseIncident",
    "ConfirmCommand",
    "DismissDispatch",
    "DoneApart",
    "ForgetWearers",
    "ImportFile",
    "NoteDispatch",
    "OpenIncident",
    "OperatorAction",
    "RegisterUnit",
    "RemoveImport",
    "ReportProblem",
    "ResolveAlarm",
    "SendCommand",
    "SetAccountability",
    "SetAnchor",
    "SetFuser",
    "SetPlan",
    "SetReference",
    "SetRest",
    "SetStart",
    "SetThresholds",
    "TakeOver",
    "Tick",
    "Unassign",
    "UndoConfirmation",
]
