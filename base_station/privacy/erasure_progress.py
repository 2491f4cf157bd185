"""Progress and result of an erasure, over all of its attempts."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

from shared.coded_text import coded

_log = logging.getLogger(__name__)
Progress = Callable[[float], None]  # receives the fraction done


@dataclass(slots=True)
class ErasureProgress:
    """Counts of what was erased so far, with those of attempts that were cut short."""

    records: int = 0  # of the log that changed or went
    files: int = 0  # that were written anew or removed
    again: bool = False  # an attempt was made before
    damaged: tuple[str, ...] = ()  # parts of the log, and their results
    kept: tuple[str, ...] = ()  # records that stay, as sentences

    def note_damage(self, part: str, written_anew: bool) -> None:
        damage = (
            coded("erasure-damage-gone", "Damaged: {part}; its unreadable part is gone", part=part)
            if written_anew
            else coded(
                "erasure-damage-stays",
                "Damaged: {part}; it stays, with all people in it",
                part=part,
            )
        )
        if damage not in self.damaged:
            _log.warning("%s", damage)
            self.damaged = (*self.damaged, damage)


@dataclass(frozen=True, slots=True)
class ErasureResult:
    """Result of an erasure over all attempts."""

    what: str  # "person 1f.." or "incident 20..", for the audit
    records: int
    files: int
    damaged: tuple[str, ...] = ()
    kept: tuple[str, ...] = ()

    def __str__(self) -> str:
        done = f"{self.what}: {self.records} records of the log in {self.files} files"
        return ". ".join((done, *self.damaged, *self.kept))
