"""Envelope of the actions, and the table of their fields on the wire."""

from __future__ import annotations

import msgspec

from shared.messages.command import CommandKind
from shared.messages.fields import get_fields, put_fields
from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import station_pb2
from shared.messages.pins import (
    PlaceBeacon,
    RemoveBeacon,
    RemovePin,
    SetMeeting,
    SetPin,
    StartTogether,
)
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
from shared.messages.station.site_actions import (
    SetAnchor,
    SetFuser,
    SetPlan,
    SetReference,
    SetStart,
)
from shared.messages.station.station_actions import DoneApart, ReportProblem, TakeOver
from shared.messages.station.unit_actions import (
    Assign,
    BeginErasure,
    ForgetWearers,
    RegisterUnit,
    SetRest,
    Unassign,
)

Action = (
    AcknowledgeAlarm
    | ResolveAlarm
    | OpenIncident
    | CloseIncident
    | AssignIncident
    | Assign
    | Unassign
    | RegisterUnit
    | SetAnchor
    | SetStart
    | SetPlan
    | SetReference
    | ReportProblem
    | SendCommand
    | ConfirmCommand
    | SetPin
    | StartTogether
    | SetMeeting
    | RemovePin
    | PlaceBeacon
    | RemoveBeacon
    | CheckIn
    | UndoConfirmation
    | SetAccountability
    | SetThresholds
    | SetFuser
    | SetRest
    | ForgetWearers
    | BeginErasure
    | TakeOver
    | DoneApart
    | NoteDispatch
    | DismissDispatch
    | ImportFile
    | RemoveImport
)

_FIELD_OF_ACTION: dict[type[Action], str] = {
    AcknowledgeAlarm: "acknowledge_alarm",
    ResolveAlarm: "resolve_alarm",
    OpenIncident: "open_incident",
    CloseIncident: "close_incident",
    AssignIncident: "assign_incident",
    Assign: "assign",
    Unassign: "unassign",
    RegisterUnit: "register_unit",
    SetAnchor: "set_anchor",
    SetStart: "set_start",
    SetPlan: "set_plan",
    SetReference: "set_reference",
    ReportProblem: "report_problem",
    SendCommand: "send_command",
    ConfirmCommand: "confirm_command",
    SetPin: "set_pin",
    StartTogether: "start_together",
    SetMeeting: "set_meeting",
    RemovePin: "remove_pin",
    PlaceBeacon: "place_beacon",
    RemoveBeacon: "remove_beacon",
    CheckIn: "check_in",
    UndoConfirmation: "undo_confirmation",
    SetAccountability: "set_accountability",
    SetThresholds: "set_thresholds",
    SetFuser: "set_fuser",
    SetRest: "set_rest",
    ForgetWearers: "forget_wearers",
    BeginErasure: "begin_erasure",
    TakeOver: "take_over",
    DoneApart: "done_apart",
    NoteDispatch: "note_dispatch",
    DismissDispatch: "dismiss_dispatch",
    ImportFile: "import_file",
    RemoveImport: "remove_import",
}
_ACTION_OF_FIELD = {field: action for action, field in _FIELD_OF_ACTION.items()}


class OperatorAction(msgspec.Struct, frozen=True):
    """Action of an operator at the console, or of the station itself."""

    header: Header
    action_id: str
    by: str
    action: Action

    def to_wire(self) -> station_pb2.OperatorAction:
        wire = station_pb2.OperatorAction(
            header=self.header.to_wire(), action_id=self.action_id, by=self.by
        )
        part = getattr(wire, _FIELD_OF_ACTION[type(self.action)])
        part.SetInParent()
        put_fields(part, self.action)
        return wire

    @staticmethod
    def from_wire(wire: station_pb2.OperatorAction) -> OperatorAction:
        """Raises ValueError where the action is one that this program does not know."""
        field = wire.WhichOneof("action")
        if field is None:
            raise ValueError("an operator's action of a kind that this program does not know")
        part = getattr(wire, field)
        action_type = _ACTION_OF_FIELD[field]
        values = get_fields(part, action_type)
        if action_type is SendCommand:
            values["kind"] = known(CommandKind, part.kind)
        action = action_type(**values)
        return OperatorAction(
            header=Header.from_wire(wire.header),
            action_id=wire.action_id,
            by=wire.by,
            action=action,
        )
