"""Waiting for what other processes do, and saying things at a steady rate."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from shared.errors import StoreError

PATIENCE_S = 180.0  # of a busy machine, on which two stations start beside others
_POLL_INTERVAL_S = 0.05
_REST = 4  # times as long as the look before


def wait_until(what: str, condition: Callable[[], object], patience_s: float = PATIENCE_S) -> float:
    """The seconds that it took.  Raises StoreError where it does not come true."""
    began_s = look_s = time.monotonic()
    while not condition():
        looked_s = time.monotonic()
        if looked_s - began_s > patience_s:
            raise StoreError(f"it did not come true within {patience_s:g} s that {what}")
        # To look may take long itself: no more than a fifth of the machine's time.
        time.sleep(max(_POLL_INTERVAL_S, _REST * (looked_s - look_s)))
        look_s = time.monotonic()
    return time.monotonic() - began_s


def paced(rate_hz: float, seconds: float) -> Iterator[int]:
    """Numbers from 0, each when it is due, and none left out where they are taken too slowly."""
    began_s = time.perf_counter()
    for number in range(round(rate_hz * seconds)):
        wait_s = began_s + number / rate_hz - time.perf_counter()
        if wait_s > 0.0:
            time.sleep(wait_s)
        yield number
