"""Time and people as events: what steps the station's pipeline beside the units' messages."""

from __future__ import annotations

import msgspec

from shared.coded_text import code_of_text
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


class Tick(msgspec.Struct, frozen=True):
    """Whatever the pipeline does because time passed, it does at a tick."""

    header: Header
    t_ns: int  # station time
    unlinked: tuple[str, ...] = ()  # units whose link was there and is gone

    def to_wire(self) -> station_pb2.Tick:
        return station_pb2.Tick(
            header=self.header.to_wire(), t_ns=self.t_ns, unlinked=self.unlinked
        )

    @staticmethod
    def from_wire(wire: station_pb2.Tick) -> Tick:
        return Tick(Header.from_wire(wire.header), wire.t_ns, tuple(wire.unlinked))


class AcknowledgeAlarm(msgspec.Struct, frozen=True):
    alarm_id: str
    last_raised_ms: int = 0  # which raising somebody saw; 0: that is not said


class ResolveAlarm(msgspec.Struct, frozen=True):
    alarm_id: str
    note: str
    last_raised_ms: int = 0  # as above
    reason: str = ""  # code of ``ResolutionReason``; empty: none was given


class OpenIncident(msgspec.Struct, frozen=True):
    incident_id: str
    name: str
    par_interval_s: float = 0.0  # 0: the usual
    work_limit_s: float = 0.0
    dispatch_number: str = ""  # of the dispatch from which it is opened; empty: of none
    beside_others: bool = False  # although others are open; else it is refused then


class CloseIncident(msgspec.Struct, frozen=True):
    """Over the alarms and the people inside that are named, knowingly: a record, no condition."""

    incident_id: str
    despite_alarm_ids: tuple[str, ...] = ()
    despite_unit_ids: tuple[str, ...] = ()


class AssignIncident(msgspec.Struct, frozen=True):
    """These units and their wearers work in this open incident, and in no other; empty: in none."""

    incident_id: str
    unit_ids: tuple[str, ...]


class Assign(msgspec.Struct, frozen=True):
    """Assignment of a unit to a person; name, crew and role only in logs of earlier versions."""

    unit_id: str
    person_id: str
    person_name: str = ""
    crew: str = ""
    role: str = ""
    keeps_incident: bool = False  # the unit stays in none where it is in none (of an erasure)


class Unassign(msgspec.Struct, frozen=True):
    unit_id: str


class RegisterUnit(msgspec.Struct, frozen=True):
    """This unit belongs to us; messages of other units are kept but not believed."""

    unit_id: str
    label: str


class SetAnchor(msgspec.Struct, frozen=True):
    """Position of the incident frame's origin on the Earth, and the direction of the plan."""

    lat_deg: float
    lon_deg: float
    height_m: float
    plan_rotation_rad: float
    incident_id: str = ""  # of whose site; empty: of the station's own


class SetStart(msgspec.Struct, frozen=True):
    """A unit's own frame begins here, with this heading, as well as the commander knows."""

    unit_id: str
    north_m: float
    east_m: float
    down_m: float
    heading_rad: float
    std_m: float
    heading_std_rad: float


class SetReference(msgspec.Struct, frozen=True):
    """This unit's barometer stays where it is and tells the weather; no unit: nobody's does."""

    unit_id: str
    down_m: float
    incident_id: str = ""  # as above


class SetPlan(msgspec.Struct, frozen=True):
    """The building's plan, metre-based site GeoJSON."""

    geojson: bytes
    incident_id: str = ""  # as above


class ReportProblem(msgspec.Struct, frozen=True):
    """The station says of itself that a part of it fails, or (no text) is well again."""

    part: str  # "log", "store" ...
    text: str  # a sentence for a person
    code: str = ""  # of the sentence; empty: of an earlier version
    texts: dict[str, str] = msgspec.field(default_factory=dict)  # parameters of the code, by name
    numbers: dict[str, float] = msgspec.field(default_factory=dict)

    @staticmethod
    def of(part: str, text: str) -> ReportProblem:
        """With the code of the text, where it has one."""
        code = code_of_text(text)
        return ReportProblem(part, str(text), code.code, code.texts, code.numbers)


class SendCommand(msgspec.Struct, frozen=True):
    """To a unit, to people, or to everyone; in logs of earlier versions, to a crew by its name.

    An order that ``repeats`` goes to the unit, or to all who have not answered; one that ends
    another goes to all whom that went to.
    """

    command_id: str
    kind: CommandKind
    unit_id: str
    crew: str
    everyone: bool
    text: str
    position_rate_hz: float  # for SET_POSITION_RATE
    lasts_s: float  # until it expires
    person_ids: tuple[str, ...] = ()
    incident_id: str = ""  # only to who is in this incident; empty: to all
    repeats: str = ""  # id of the order that is sent again; empty: this is a new one
    # Of ALL_CLEAR, the evacuation; of END_ORDER, the LOCATE that is stopped.
    ended_command_id: str = ""


class ConfirmCommand(msgspec.Struct, frozen=True):
    """The member answered the command by radio."""

    command_id: str
    unit_id: str


class CheckIn(msgspec.Struct, frozen=True):
    """PAR by radio, of a unit's wearer, of people or of everyone; a crew as in ``SendCommand``."""

    unit_id: str
    crew: str
    everyone: bool
    check_in_id: str = ""  # by which it can be undone; empty: of an old log
    person_ids: tuple[str, ...] = ()
    incident_id: str = ""  # of who is in this incident; empty, of everyone: in the only open one


class UndoConfirmation(msgspec.Struct, frozen=True):
    """Undoing what was entered by radio."""

    entry_id: str  # of the check-in, or of the command that was confirmed
    unit_id: str = ""  # empty: of all whom that confirmed


class SetAccountability(msgspec.Struct, frozen=True):
    """Intervals of an incident: between two PARs of a member, and until rehab."""

    par_interval_s: float
    work_limit_s: float
    incident_id: str = ""  # empty: the only open one


class SetThresholds(msgspec.Struct, frozen=True):
    """Thresholds of alarm rules, by ``rule.threshold``; what is not named has its default."""

    thresholds: dict[str, float]


class SetFuser(msgspec.Struct, frozen=True):
    """Fuser of all units from here on, by its name."""

    name: str


class SetRest(msgspec.Struct, frozen=True):
    unit_id: str
    resting: bool


class ForgetWearers(msgspec.Struct, frozen=True):
    """Nothing is to be remembered of who has worn this unit so far."""

    unit_id: str


class BeginErasure(msgspec.Struct, frozen=True):
    """Every station that has this log erases a subject from the records before this one."""

    kind: str  # "person" or "incident"
    subject_id: str


class TakeOver(msgspec.Struct, frozen=True):
    """From here on this station orders what happens; two stations' logs are compared by these."""

    term: int  # higher than any before
    station: str
    after_t_ns: int  # the place behind which it stands: the last event's time,
    after_count: int  # and how many events had that time


class DoneApart(msgspec.Struct, frozen=True):
    """Operator's action at another station while the two were apart: kept, not applied."""

    station: str
    t_ns: int  # that station's time
    who: str
    what: str  # a sentence


class NoteDispatch(msgspec.Struct, frozen=True):
    """Report of the dispatch centre about an incident; a later one with the number replaces it."""

    number: str
    source: str  # format in which it came: "eido" or "json"
    type: str = ""  # of the incident, in words
    type_code: str = ""  # as the dispatch centre has it
    priority: str = ""
    address: str = ""
    lat_deg: float | None = None
    lon_deg: float | None = None
    units: tuple[str, ...] = ()  # call signs of vehicles or crews
    called_ns: int = 0  # UTC: the call was taken; 0: unknown
    dispatched_ns: int = 0
    updated_ns: int = 0  # when the dispatch centre changed it last
    remarks: str = ""
    has_ended: bool = False  # the dispatch centre has closed or cancelled it
    warnings: tuple[str, ...] = ()  # about parts of the report that were left out


class DismissDispatch(msgspec.Struct, frozen=True):
    """This dispatch opens no incident here."""

    number: str


class ImportFile(msgspec.Struct, frozen=True):
    """A file from elsewhere becomes part of an incident; it stands beside the log."""

    incident_id: str
    import_id: str  # by its content: the same file has the same one
    file_name: str  # as it was called where it comes from
    format: str  # "gpx", "kml", "photo" or "incident"
    sha256: str
    size_bytes: int
    shift_s: float  # added to its times
    first_ns: int  # times of what is in it, shifted
    last_ns: int


class RemoveImport(msgspec.Struct, frozen=True):
    """The file is taken out of the incident again, and removed."""

    incident_id: str
    import_id: str


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
