"""Whose link is there and whose is gone, by liveliness tokens: sooner than silence tells it."""

from __future__ import annotations

from shared.bus import Bus
from shared.channels import alive_key

_BEFORE, _BEHIND = alive_key("*").split("*")


class LinkedUnits:
    """From its making until it is closed; any thread asks."""

    def __init__(self, bus: Bus) -> None:
        self._linked: frozenset[str] = frozenset()
        self._unlinked: frozenset[str] = frozenset()
        self._watch = bus.watch_alive(alive_key("*"), self._note)

    @property
    def linked(self) -> frozenset[str]:
        return self._linked

    @property
    def unlinked(self) -> frozenset[str]:
        """Were there before."""
        return self._unlinked

    def close(self) -> None:
        self._watch.close()

    def _note(self, key: str, there: bool) -> None:
        """Called by one thread of the bus."""
        unit_ids = {key.removeprefix(_BEFORE).removesuffix(_BEHIND)}
        linked, unlinked = self._linked, self._unlinked
        self._linked = linked | unit_ids if there else linked - unit_ids
        self._unlinked = unlinked - unit_ids if there else unlinked | unit_ids
