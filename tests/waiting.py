"""Waiting for what other threads and processes do."""

from __future__ import annotations

import time
from collections.abc import Callable

PATIENCE_S = 120.0  # of a busy machine; nothing is measured by it
_LOOK_EVERY_S = 0.02


def until(
    condition: Callable[[], object],
    what: str = "it",
    patience_s: float = PATIENCE_S,
    look_every_s: float = _LOOK_EVERY_S,
) -> None:
    """Until ``what`` is so; an AssertionError that names it where that does not come about."""
    end_s = time.monotonic() + patience_s
    while not condition():
        assert time.monotonic() < end_s, f"waited in vain for this: {what}"
        time.sleep(look_every_s)
