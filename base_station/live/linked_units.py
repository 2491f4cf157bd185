"""Whose link was there and is gone, by liveliness tokens: sooner than silence tells it."""

from __future__ import annotations

from shared.bus import Bus
from shared.channels import alive_key

_BEFORE, _BEHIND = alive_key("*").split("*")


class LinkedUnits:
    """From its making until it is closed; any thread asks."""

    def __init__(self, bus: Bus) -> None:
        self._unlinked: frozenset[str] = frozenset()
        self._watch = bus.watch_alive(alive_key("*"), self._note)

    @property
    def unlinked(self) -> frozenset[str]:
        return self._unlinked

    def close(self) -> None:
        self._watch.close()

    def _note(self, key: str, there: bool) -> None:
        """Called by one thread of the bus."""
        unit_ids = {key.removeprefix(_BEFORE).removesuffix(_BEHIND)}
        self._unlinked = self._unlinked - unit_ids if there else self._unlinked | unit_ids
