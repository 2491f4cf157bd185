"""Waiting for what other threads and processes do."""

from __future__ import annotations

import time
from collections.abc import Callable

PATIENCE_S = 120.0  # of a busy machine; nothing is measured by it
_POLL_INTERVAL_S = 0.02
_REST = 4  # times as long as the look before


def until(
    condition: Callable[[], object],
    what: str = "it",
    patience_s: float = PATIENCE_S,
    poll_interval_s: float = _POLL_INTERVAL_S,
) -> None:
    """Until ``what`` is so; an AssertionError that names it where that does not come about."""
    look_s = time.monotonic()
    end_s = look_s + patience_s
    while not condition():
        looked_s = time.monotonic()
        assert looked_s < end_s, f"waited in vain for this: {what}"
        # To look may take long itself: no more than a fifth of the machine's time.
        time.sleep(max(poll_interval_s, _REST * (looked_s - look_s)))
        look_s = time.monotonic()
