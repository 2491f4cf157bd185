"""Lock for decoding pictures: one at a time, as each takes memory, and few wait, as each
of those holds an upload and a thread that others need.
"""

from __future__ import annotations

from threading import BoundedSemaphore, Lock

from base_station.api.problems import Problem

MAX_WAITING = 3
RETRY_AFTER_S = 5


class ImageLock:
    """Context manager around the decoding of a picture; Problem 429 where too many wait."""

    def __init__(self) -> None:
        self._places = BoundedSemaphore(1 + MAX_WAITING)
        self._turn = Lock()

    def __enter__(self) -> None:
        if not self._places.acquire(blocking=False):
            raise Problem(
                429,
                "Other pictures are being read, one at a time; send this one again in some "
                "seconds.",
                {"Retry-After": str(RETRY_AFTER_S)},
            )
        self._turn.acquire()

    def __exit__(self, *_: object) -> None:
        self._turn.release()
        self._places.release()
