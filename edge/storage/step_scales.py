"""Learnt lengths of steps on disk, of each person and of each place on the body.

A person is kept by a digest of the name that the settings give, so that the file has no names; the
scale of one is never that of another.  A file that cannot be read is set aside, and all begin anew.
"""

from __future__ import annotations

import hashlib
import logging
import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import msgspec

from edge.tracker.interface import StepScale
from shared.durable_names import sync_folder
from shared.errors import RecordingError
from shared.own_files import read_own, write_own

logger = logging.getLogger(__name__)

_UNFINISHED, _DAMAGED = ".new", ".damaged"


class _KeptScale(msgspec.Struct, frozen=True):
    """Scale of one person at one place."""

    factor: float
    std: float

    def __post_init__(self) -> None:
        if not (0.5 <= self.factor <= 2.0 and 0.0 < self.std <= 0.5):
            raise ValueError(f"{self.factor} +- {self.std} is no scale of steps")


class _ScaleFile(msgspec.Struct, frozen=True):
    people: dict[str, dict[str, _KeptScale]] = msgspec.field(default_factory=dict)


class ForgottenSteps(NamedTuple):
    """Scales that were deleted."""

    places: tuple[str, ...]  # of the sensor
    unreadable: tuple[Path, ...]  # files of unknown people


class StepScales:
    """Learnt scales of the steps of one person; those of others stay in the file."""

    def __init__(self, path: Path, person: str) -> None:
        """``person``: as in the settings; empty: not known, and nothing is read or kept."""
        self._path = path
        self._person = _digest(person) if person else ""
        self._people = _read(path).people if person else {}

    @property
    def learnt(self) -> Mapping[str, StepScale]:
        """By place of the sensor, as of the last ``save`` before this start."""
        return _scales(self._people.get(self._person, {}))

    def save(self, scales: Mapping[str, StepScale]) -> None:
        """Write the scales of this person at these places.  Raises OSError."""
        if not self._person or not scales:
            return
        kept = {place: _KeptScale(one.factor, one.std) for place, one in scales.items()}
        of_person = {**self._people.get(self._person, {}), **kept}
        self._people = {**self._people, self._person: of_person}
        self._write()

    def forget(self) -> ForgottenSteps:
        """Delete the scales of this person; without a person there is nothing to delete.

        Files that were left unfinished, or set aside because they could not be read, are deleted
        whole, as it is not known whose scales they have.  Raises OSError.
        """
        if not self._person:
            return ForgottenSteps((), ())
        places = tuple(self._people.get(self._person, {}))
        self._people = {one: kept for one, kept in self._people.items() if one != self._person}
        if places:
            self._write()
        unreadable = tuple(one for one in files_of(self._path)[1:] if one.exists())
        for one in unreadable:
            one.unlink()
        sync_folder(self._path.parent)
        return ForgottenSteps(places, unreadable)

    def _write(self) -> None:
        new = self._path.with_suffix(_UNFINISHED)
        with write_own(new, 0o600) as written:
            written.write(msgspec.json.encode(_ScaleFile(self._people)))
            written.flush()
            os.fsync(written.fileno())
        new.replace(self._path)
        sync_folder(self._path.parent)


def files_of(path: Path) -> tuple[Path, Path, Path]:
    """Return the file and the two that may be left beside it: unfinished, and set aside."""
    return path, path.with_suffix(_UNFINISHED), path.with_suffix(_DAMAGED)


def read_learnt(path: Path, person: str) -> Mapping[str, StepScale]:
    """Return the scales of a person by place, from the file of a unit that may be running; nothing
    is changed.

    Raises RecordingError for a file that cannot be read.
    """
    try:
        return _scales(_decoded(path).people.get(_digest(person), {}))
    except (OSError, msgspec.DecodeError) as error:
        raise RecordingError(f"{path} cannot be read: {error}") from error


def _digest(person: str) -> str:
    return hashlib.sha256(person.encode()).hexdigest()[:16]


def _scales(kept: Mapping[str, _KeptScale]) -> dict[str, StepScale]:
    return {place: StepScale(one.factor, one.std) for place, one in kept.items()}


def _decoded(path: Path) -> _ScaleFile:
    with read_own(path) as file:
        return msgspec.json.decode(file.read(), type=_ScaleFile)


def _read(path: Path) -> _ScaleFile:
    try:
        return _decoded(path)
    except FileNotFoundError:
        return _ScaleFile()
    except (OSError, msgspec.DecodeError) as error:  # a unit must start in any case
        aside = path.with_suffix(_DAMAGED)
        logger.warning("the learnt lengths of steps cannot be read (%s), and begin anew", error)
        try:
            path.replace(aside)
        except OSError as unmoved:
            logger.warning("%s cannot be set aside: %s", path, unmoved)
        return _ScaleFile()
