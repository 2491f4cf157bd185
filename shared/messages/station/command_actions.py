"""Commands to wearers, and accountability: roll call, answers by radio, intervals."""

from __future__ import annotations

import msgspec

from shared.messages.command import CommandKind


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
    unit_id: str = ""  # empty: of all members that it confirmed


class SetAccountability(msgspec.Struct, frozen=True):
    """Intervals of an incident: between two PARs of a member, and until rehab."""

    par_interval_s: float
    work_limit_s: float
    incident_id: str = ""  # empty: the only open one
