"""Actions on units and their wearers, and on what is known of them."""

from __future__ import annotations

import msgspec


class RegisterUnit(msgspec.Struct, frozen=True):
    """Registration of a unit; messages of other units are kept but not used."""

    unit_id: str
    label: str


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
