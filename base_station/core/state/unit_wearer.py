"""Wearers of a unit, the present one and former ones."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from base_station.core.person_references import reference_to

ERASED_TEXT = "(forgotten)"  # in place of a text about a person
WEARERS_KEPT = 20  # wearers of a unit, beside those of its alarms; the log has all of them


class Person(msgspec.Struct, frozen=True):
    """Wearer of a unit; name, crew and role only where the log is of an earlier version."""

    person_id: str
    name: str = ""
    crew: str = ""
    role: str = ""

    @property
    def named(self) -> str:
        """Name, or the reference that is replaced by the name when it is shown."""
        return self.name or reference_to(self.person_id)


class FormerWearer(msgspec.Struct, frozen=True):
    """Former wearer of a unit; station times, ``until_ns`` excluded."""

    name: str
    from_ns: int
    until_ns: int


class UnitWearer(msgspec.Struct):
    """Present and former wearers."""

    person: Person | None = None
    since_ns: int = 0  # begin of the wearing by that person, or of not being worn
    former: list[FormerWearer] = msgspec.field(default_factory=list)  # oldest first

    @property
    def person_id(self) -> str | None:
        """Id of the present wearer; None: the unit is not worn."""
        return None if self.person is None else self.person.person_id

    def from_ns(self, t_ns: int | None) -> int | None:
        """Begin of the wearing of that time, 0: it was not worn; names one wearing of this unit.
        None: the time is unknown.
        """
        if t_ns is None:
            return None
        if t_ns >= self.since_ns:
            return self.since_ns if self.person else 0
        worn = self.former_at(t_ns)
        return worn.from_ns if worn else 0

    def former_at(self, t_ns: int) -> FormerWearer | None:
        """Former wearer of that time; None: it was not worn."""
        worn = [one for one in self.former if one.from_ns <= t_ns < one.until_ns]
        return worn[-1] if worn else None

    def end(self, t_ns: int, is_concerned: Callable[[FormerWearer], bool]) -> None:
        """End the wearing; ``is_concerned``: an alarm may be about this wearer."""
        if self.person is not None:
            former = FormerWearer(self.person.named, self.since_ns, t_ns)
            wearers = [*self.former, former]
            concerned = [one for one in wearers[:-WEARERS_KEPT] if is_concerned(one)]
            self.former = [*concerned, *wearers[-WEARERS_KEPT:]]
        self.person, self.since_ns = None, t_ns

    def erase_names(self) -> None:
        """Erase the names of former wearers; the times of wearing stay."""
        self.former = [msgspec.structs.replace(one, name=ERASED_TEXT) for one in self.former]
