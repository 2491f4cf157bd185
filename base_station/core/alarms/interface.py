"""Interface of an alarm rule: a pure judgement of one unit at one instant."""

from __future__ import annotations

from typing import Protocol

import msgspec

from base_station.core.alarms.sentences import sentence
from base_station.core.state import UnitState
from shared.coded_text import coded
from shared.messages import AlarmParameters, Message

EMERGENCY, WARNING, ADVISORY = 1, 2, 3  # priorities


class Finding(msgspec.Struct, frozen=True):
    """Finding that the unit's state calls for an alarm."""

    level: str  # one of the rule's levels
    priority: int
    code: str  # of its sentence, in ``sentences``
    parameters: AlarmParameters  # of the sentence
    seen_ns: int  # station time of the evidence
    onset_ns: int = 0  # beginning of the condition; one after a resolution is a new alarm
    latched: bool = False  # only a person resolves it
    about: int | str | None = None  # identity among several of one unit: the wearer, or the fault
    measured: float | None = None  # value that was judged, in the rule's unit; None: none
    is_low: bool = False  # of values the lowest is the worst

    @property
    def text(self) -> str:
        """The sentence in English, for logs, exports and programs."""
        return sentence(self.code, self.parameters)


class Clear(msgspec.Struct, frozen=True):
    """There is evidence that nothing is the matter."""

    seen_ns: int  # station time of the evidence: the passing of time alone clears nothing
    by: str  # cause of the resolution, with its code
    at_once: bool = False  # conclusive: the condition need not last
    about: int | None = None  # wearer that the evidence concerns, where that counts


def switched_off(unit: UnitState) -> Clear | None:
    """Verdict of a unit that was switched off in order: its alarm's condition is not expected."""
    if unit.stopped_ns is None:
        return None
    return Clear(
        unit.stopped_ns, coded("over-switched-off", "the unit was switched off"), at_once=True
    )


def off_duty(unit: UnitState) -> Clear:
    """Verdict of a rule about duty where the unit is not worn, or no incident is open."""
    return Clear(unit.off_duty_ns, coded("over-off-duty", "off duty"))


Verdict = Finding | Clear | None  # None: nothing is known either way


class AlarmRule(Protocol):
    """A frozen dataclass without state of its own; its fields are its thresholds."""

    @property
    def name(self) -> str:
        """Short, lower case, with hyphens: it is in the log for ever."""
        ...

    @property
    def levels(self) -> tuple[str, ...]:
        """From least to worst."""
        ...

    @property
    def clear_after_s(self) -> float:
        """Time for which the evidence must stay clear, or lower, before the alarm follows it."""
        ...

    @property
    def rearm_after_s(self) -> float | None:
        """Time after which an alarm is raised again that a person resolved although its cause
        lasts; None: only when the cause was gone in between, or is worse.
        """
        ...

    @property
    def applies_to_unregistered(self) -> bool:
        """True for a rule that also judges units that are not registered."""
        ...

    @property
    def triggered_by(self) -> tuple[type[Message], ...]:
        """Frequent messages that trigger the rule at once.  Besides, every rule judges at every
        tick and after every message that is not frequent.
        """
        ...

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:
        """``t_ns`` station time now; ``level`` that of the open alarm, empty without one."""
        ...
