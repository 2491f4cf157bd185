"""State of units' links by liveliness tokens, which end sooner than a timeout would."""

from __future__ import annotations

from collections.abc import Callable

from base_station.process.token_bucket import TokenBucket
from shared.bus import Bus
from shared.channels import alive_key
from shared.clock import Clock

_BEFORE, _BEHIND = alive_key("*").split("*")
# A link that comes and goes does so a few times a second at most.  Nothing can drop tokens before
# messages are here, and each delays those behind it.
CHANGES_HZ = 4.0
CHANGES_AT_ONCE = 100.0
_WHY = "appears and vanishes on the bus many times a second"


class LivenessMonitor:
    """Monitor of all links.  It runs until it is closed; any thread may read it."""

    def __init__(self, bus: Bus, ban: Callable[[str, str], None], clock: Clock) -> None:
        """``ban`` bans a flooding unit; it takes the reason as text that follows the unit's
        name.
        """
        self._ban = ban
        self._clock = clock
        self._changes: dict[str, TokenBucket] = {}
        self._linked: frozenset[str] = frozenset()
        self._unlinked: frozenset[str] = frozenset()
        self._watch = bus.watch_alive(alive_key("*"), self._note)

    @property
    def linked(self) -> frozenset[str]:
        return self._linked

    @property
    def unlinked(self) -> frozenset[str]:
        """Units that had a link before and have none now."""
        return self._unlinked

    def close(self) -> None:
        self._watch.close()

    def _note(self, key: str, there: bool) -> None:
        """Called by one thread of the bus."""
        unit_id = key.removeprefix(_BEFORE).removesuffix(_BEHIND)
        now_ns = self._clock.monotonic_ns()
        changes = self._changes.get(unit_id)
        if changes is None:
            changes = self._changes[unit_id] = TokenBucket(CHANGES_HZ, CHANGES_AT_ONCE, now_ns)
        if not changes.take(1, now_ns):
            self._ban(unit_id, _WHY)
            if unit_id in self._unlinked:
                return  # until it is quiet: the rest is not worth the time
            there = False
        unit_ids = {unit_id}
        linked, unlinked = self._linked, self._unlinked
        self._linked = linked | unit_ids if there else linked - unit_ids
        self._unlinked = unlinked - unit_ids if there else unlinked | unit_ids
