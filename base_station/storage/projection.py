"""Changes of the queryable store that follow from the log, and the writer that takes them."""

from __future__ import annotations

from typing import Protocol

import msgspec

from shared.messages import AlarmChange, FusedPosition, OperatorAction, UnitDescription


class Projection(msgspec.Struct, frozen=True):
    """What one step of the drive changes in the queryable store; every part is idempotent, so
    that a log may be projected again.
    """

    t_ns: int  # station time
    alarms: tuple[AlarmChange, ...] = ()
    tracks: tuple[FusedPosition, ...] = ()  # at most one a second and unit
    actions: tuple[OperatorAction, ...] = ()  # that were accepted
    descriptions: tuple[UnitDescription, ...] = ()
    heard: tuple[tuple[str, int], ...] = ()  # (unit id, station time), every five seconds or so
    news: tuple[str, ...] = ()  # closed incidents of whose time more is known


class ProjectionSink(Protocol):
    """The SQL store's writer."""

    def project(self, projection: Projection) -> None:
        """Never raises for a store that fails: it says so in ``problem`` and tries again."""
        ...

    def problem(self) -> str:
        """Why the store is not keeping up, as a sentence for a person; empty: all is well."""
        ...
