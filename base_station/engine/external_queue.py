"""People and markers from other systems that wait for the engine."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable
from typing import Final

from shared.channels import EXTERNAL
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, ExternalMarker, ExternalMarkers

_KEY: Final = EXTERNAL.key(STATION_ID)
_WAITING_MAX: Final = 20  # batches of other systems, of a second each

log = logging.getLogger(__name__)


class ExternalQueue:
    """Batches that wait.  ``put`` may be called from any thread, ``apply_waiting`` in the engine's
    thread.
    """

    def __init__(
        self, append_and_apply: Callable[[int, str, bytes], object], header_factory: HeaderFactory
    ) -> None:
        """``append_and_apply`` logs a record with a time and a key, then applies it."""
        self._append_and_apply = append_and_apply
        self._header_factory = header_factory
        self._waiting: deque[tuple[tuple[ExternalMarker, ...], tuple[str, ...]]] = deque(
            maxlen=_WAITING_MAX
        )

    def put(self, markers: tuple[ExternalMarker, ...], removed: tuple[str, ...]) -> None:
        """Queue markers, and the ids of removed ones; a full queue drops its oldest batch."""
        if len(self._waiting) == _WAITING_MAX:
            log.warning("other systems send markers faster than they are taken: some are left out")
        self._waiting.append((markers, removed))

    def apply_waiting(self, not_before_ns: int) -> None:
        """Log and apply the waiting batches, with times not before ``not_before_ns``."""
        for _ in range(len(self._waiting)):
            message = ExternalMarkers(self._header_factory.header(), *self._waiting.popleft())
            t_ns = max(message.header.t_utc_ns, not_before_ns)
            self._append_and_apply(t_ns, _KEY, encode(message))
