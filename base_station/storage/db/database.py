"""Interface of a station's database, for readers and writers of its tables."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Protocol, Self

from sqlalchemy.orm import Session

IN_MEMORY = "muster_in_memory"  # of ``Session.info``, behind ``write``


class Database(Protocol):
    """A file (``store.Store``) or a server (``server_store.ServerStore``).  Thread-safe."""

    loss: str  # missing data since it was made again, as a sentence for a person

    @property
    def name(self) -> str:
        """The file, or the server's address, for messages; without a password."""
        ...

    @property
    def problem(self) -> str:
        """Problem of the database, as a sentence for a person; empty: none."""
        ...

    @property
    def in_memory(self) -> bool:
        """True if its disk cannot be written: changes are in memory and wait for it."""
        ...

    @property
    def is_away(self) -> bool:
        """True if it does not answer: calls then fail at once."""
        ...

    def read(self) -> AbstractContextManager[Session]:
        """A consistent view for one reader.  Raises StoreError where it cannot be read."""
        ...

    def write(self, *, is_kept: bool = True) -> AbstractContextManager[Session]:
        """One transaction, committed at the end of the block; one at a time.  What is not
        ``is_kept`` while the database takes nothing is done again by the caller.  Raises
        StoreError where the database cannot take it.
        """
        ...

    def check_disk(self) -> None:
        """Try to return to the disk; called at intervals while nothing is to be written."""
        ...

    def compact(self) -> int:
        """Overwrite deleted and replaced data; returns the number of files removed."""
        ...

    def close(self) -> None: ...

    def __enter__(self) -> Self: ...

    def __exit__(self, *_: object) -> None: ...
