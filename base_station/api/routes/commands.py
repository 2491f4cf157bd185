"""Commands to units, and their delivery to each of them."""

from __future__ import annotations

import uuid
from enum import StrEnum
from typing import Annotated, Literal

from fastapi import APIRouter
from pydantic import Discriminator, Field, Tag

from base_station.api.authentication import Viewer
from base_station.api.forms import Form, Id, Note, PersonIdText, ShortText, UnitIdText
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.request_incident import open_or_404
from base_station.api.services import Services, Station
from base_station.views.wire import CommandView
from shared.coded_text import coded
from shared.messages import CommandKind
from shared.messages.station import ConfirmCommand, SendCommand, UndoConfirmation

router = APIRouter(tags=["commands"])


class Kind(StrEnum):
    EVACUATE = "evacuate"
    PAR_REQUEST = "par_request"
    TEXT = "text"
    LOCATE = "locate"
    SET_POSITION_RATE = "set_position_rate"


class UnitTarget(Form):
    unit_id: UnitIdText


class CrewTarget(Form):
    crew: Annotated[ShortText, Field(min_length=1)]


class EveryoneTarget(Form):
    everyone: Literal[True]


class FloorTarget(Form):
    floor: Annotated[int, Field(ge=-100, le=200)]


def _kind_of_target(target: object) -> object:
    """The only key of the target, which names its kind; None if there is not exactly one."""
    return next(iter(target)) if isinstance(target, dict) and len(target) == 1 else None


Target = Annotated[
    Annotated[UnitTarget, Tag("unit_id")]
    | Annotated[CrewTarget, Tag("crew")]
    | Annotated[FloorTarget, Tag("floor")]
    | Annotated[EveryoneTarget, Tag("everyone")],
    Discriminator(
        _kind_of_target,
        custom_error_type="target",
        custom_error_message="must be one kind of target",
    ),
]


def members_of(target: object, station: Services) -> tuple[str, ...]:
    """Ids of the people in a crew or on a floor now; empty for any other kind of target.

    A member whose floor is not known is included, as that person may be on it.
    """
    if isinstance(target, CrewTarget):
        return station.roster.crew(target.crew)
    if not isinstance(target, FloorTarget):
        return ()
    floors = {target.floor, None}
    return tuple(
        unit.person.person_id
        for unit in station.picture().units
        if unit.person is not None and (unit.position is None or unit.position.floor in floors)
    )


Lasts = Annotated[float, Field(ge=1.0, le=86_400.0)]  # s


class NewCommand(Form):
    kind: Kind
    target: Target
    text: Note = ""
    position_rate_hz: Annotated[float, Field(ge=0.1, le=50.0)] = 5.0  # for set_position_rate
    incident_id: PersonIdText | None = None  # only to its members; None: to all of the target
    expires_s: Lasts = 600.0


class Confirmation(Form):
    unit_id: UnitIdText


class Repeat(Form):
    unit_id: UnitIdText | None = None  # None: all members without an answer
    expires_s: Lasts = 600.0


class AllClear(Form):
    expires_s: Lasts = 600.0


@router.get("/commands")
def list_commands(station: Station, _: Viewer) -> list[CommandView]:
    """Open commands and the last closed ones, oldest first; the audit lists all."""
    return list(station.picture().commands)


@router.get("/commands/{command_id}")
def get_command(command_id: Id, station: Station, _: Viewer) -> CommandView:
    return _command_or_404(station, command_id)


@router.post("/commands", status_code=201)
def send(new: NewCommand, station: Station, perform: Perform) -> CommandView:
    """Send a command to the units of a target.  Each unit gets it again until it answers, for
    ``expires_s`` from now at most.
    """
    action = SendCommand(
        command_id=uuid.uuid4().hex,
        kind=CommandKind[new.kind.name],
        unit_id=new.target.unit_id if isinstance(new.target, UnitTarget) else "",
        crew="",
        everyone=isinstance(new.target, EveryoneTarget),
        text=new.text,
        position_rate_hz=new.position_rate_hz if new.kind is Kind.SET_POSITION_RATE else 0.0,
        lasts_s=new.expires_s,
        person_ids=members_of(new.target, station),
        incident_id=_named(station, new.incident_id),
    )
    return _command_or_404(station, perform(action).created_id)


@router.post("/commands/{command_id}/repeat")
def repeat(command_id: Id, new: Repeat, station: Station, perform: Perform) -> CommandView:
    """Send an order again to one unit, or to all units that have not answered; they notify their
    wearers again.
    """
    order = _command_or_404(station, command_id)
    unit_id = new.unit_id or ""
    kind = CommandKind[order.kind.upper()]
    perform(_later(kind, new.expires_s, unit_id=unit_id, repeats=command_id))
    return _command_or_404(station, command_id)


@router.post("/commands/{command_id}/all-clear", status_code=201)
def give_all_clear(
    command_id: Id, new: AllClear, station: Station, perform: Perform
) -> CommandView:
    """End an evacuation, and notify every member for whom it was.  The answer is the all clear."""
    _command_or_404(station, command_id)
    action = _later(CommandKind.ALL_CLEAR, new.expires_s, ended_command_id=command_id)
    return _command_or_404(station, perform(action).created_id)


@router.post("/commands/{command_id}/stop", status_code=204)
def stop(command_id: Id, station: Station, perform: Perform) -> None:
    """Stop the signal that a locate order has started."""
    _command_or_404(station, command_id)
    perform(_later(CommandKind.END_ORDER, 600.0, ended_command_id=command_id))


@router.post("/commands/{command_id}/confirm", status_code=204)
def confirm(command_id: Id, by_radio: Confirmation, station: Station, perform: Perform) -> None:
    """Enter that the member answered by radio, which acknowledges the command."""
    _command_or_404(station, command_id)
    perform(ConfirmCommand(command_id, by_radio.unit_id))


@router.post("/commands/{command_id}/confirm/undo", status_code=204)
def undo_confirm(
    command_id: Id, by_radio: Confirmation, station: Station, perform: Perform
) -> None:
    """Undo an answer by radio that was entered in error.  The command waits for this member again,
    and so does the PAR that the answer confirmed.
    """
    _command_or_404(station, command_id)
    perform(UndoConfirmation(command_id, by_radio.unit_id))


def _later(
    kind: CommandKind,
    lasts_s: float,
    *,
    unit_id: str = "",
    repeats: str = "",
    ended_command_id: str = "",
) -> SendCommand:
    """Order that refers to an earlier one."""
    return SendCommand(
        command_id=uuid.uuid4().hex,
        kind=kind,
        unit_id=unit_id,
        crew="",
        everyone=not unit_id,
        text="",
        position_rate_hz=0.0,
        lasts_s=lasts_s,
        repeats=repeats,
        ended_command_id=ended_command_id,
    )


def _named(station: Services, incident_id: str | None) -> str:
    return "" if incident_id is None else open_or_404(station, incident_id).incident_id


def _command_or_404(station: Services, command_id: str) -> CommandView:
    for view in station.picture().commands:
        if view.command_id == command_id:
            return view
    raise Problem(404, coded("command-unknown", "There is no such command."))
