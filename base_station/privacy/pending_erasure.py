"""File of the erasures that have begun and are not finished.

A log of which a part is rewritten does not show any more which people were at the incident, so
their extent is saved before.
"""

from __future__ import annotations

from pathlib import Path

import msgspec

from base_station.core.erasure.erasure import (
    Erasure,
    HandBack,
    Reassignment,
    inserted_action_id,
)
from base_station.storage.private_files import write_atomically
from shared.coded_text import coded
from shared.errors import StoreError
from shared.messages.station import Assign


class _OlderErasure(msgspec.Struct, frozen=True):
    """Record that an earlier version kept of the actions that it puts into the log."""

    returned_units: tuple[str, ...] = ()  # before the opening
    assigned_after: tuple[Assign, ...] = ()  # behind the closing
    opening_id: str = ""
    closing_id: str = ""


def _with_actions(erasure: Erasure, older: _OlderErasure) -> Erasure:
    """Convert an erasure that an earlier version has begun."""
    if not older.opening_id:
        return erasure
    return msgspec.structs.replace(
        erasure,
        hand_backs=tuple(HandBack(older.opening_id, one) for one in older.returned_units),
        reassignments=tuple(
            Reassignment(older.closing_id, one, inserted_action_id(older.closing_id, one.unit_id))
            for one in older.assigned_after
        ),
    )


class PendingErasure:
    """Unfinished erasures of incidents; used in one thread."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def of(self, incident_id: str) -> Erasure | None:
        """Extent as it was before the first removal.  Raises StoreError where it cannot be read."""
        return next((one for one in self._read() if one.incident_id == incident_id), None)

    def keep(self, erasure: Erasure) -> None:
        """Save an erasure; it is on the disk when this returns.  Raises StoreError."""
        self._write([*self._read(), erasure])

    def remove(self, incident_id: str) -> None:
        """Remove it, as all of its data is erased.  Raises StoreError."""
        begun = self._read()
        left = [one for one in begun if one.incident_id != incident_id]
        if len(left) < len(begun):
            self._write(left)

    def _read(self) -> list[Erasure]:
        try:
            content = self._path.read_bytes()
            found = msgspec.json.decode(content, type=list[Erasure])
            older = msgspec.json.decode(content, type=list[_OlderErasure])
        except FileNotFoundError:
            return []
        except (OSError, msgspec.DecodeError) as error:
            raise StoreError(
                coded(
                    "erasure-list-unreadable",
                    "{path} tells what is being forgotten and cannot be read ({error}): restore "
                    "it from a backup, or remove it and forget again",
                    path=str(self._path),
                    error=str(error),
                )
            ) from error
        return [_with_actions(one, before) for one, before in zip(found, older, strict=True)]

    def _write(self, begun: list[Erasure]) -> None:
        """Write the file, private as it contains names; remove it where nothing is left."""
        if begun:
            write_atomically(self._path, msgspec.json.encode(begun))
        else:
            self._path.unlink(missing_ok=True)
