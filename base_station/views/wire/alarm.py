"""View of an alarm, with the amounts and names in its sentence."""

from __future__ import annotations

import msgspec

from base_station.views.answer import Answer


class AlarmParametersView(Answer, frozen=True, omit_defaults=True):
    """Quantities and names in the sentence of an alarm; those that the sentence does not contain
    are left out.
    """

    member: str | None = None  # its wearer, or the unit where it is not worn
    member_before: str | None = None  # the former wearer, where it may concern that person
    unit_id: str | None = None
    duration_s: float | None = None
    temperature_degc: float | None = None  # of the air around the equipment
    heat_fraction: float | None = None  # used part of the equipment's heat limit; 1: all of it
    battery_fraction: float | None = None
    radius_m: float | None = None  # that holds the member with 95 % probability
    reasons: tuple[str, ...] = ()  # why an estimate is poor, or a fix is not used; codes
    fault: str | None = None  # text of the unit, its agent or the station
    part: str | None = None  # of the station, that fails
    calibrated_s: int | None = None  # UTC seconds
    fault_code: str | None = None  # of the sentence in ``fault``, where it has one
    fault_texts: dict[str, str] = msgspec.field(
        default_factory=dict
    )  # parameters of ``fault_code``, by name
    fault_numbers: dict[str, float] = msgspec.field(default_factory=dict)


class AlarmView(Answer, frozen=True):
    alarm_id: str
    rule: str
    unit_id: str
    priority: int
    state: str  # raised | acknowledged | resolved
    level: str
    text: str
    by: str
    raised_ms: int
    last_raised_ms: int  # at first, or anew: it got worse, or happened again
    changed_ms: int
    code: str = ""  # of the sentence; empty: recorded by an earlier version, there is only the text
    parameters: AlarmParametersView = AlarmParametersView()
    reason: str = ""  # code of the reason for which a user resolved it; empty: none was given
    note: str = ""  # the user's note
    peak: float | None = None  # worst measured value of the rule until changed_ms
