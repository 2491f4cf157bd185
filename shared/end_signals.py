"""Ctrl-C, and what a service manager sends: a program is told to end."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from queue import SimpleQueue
from threading import Event, Thread


def told_to_end() -> Event:
    """Set once this program is told to end, as often as it is told; for the main thread to call.

    Not set by the handler itself: that runs between any two steps of the main thread, which may
    hold the event's lock just then, and would wait for itself for ever.  A queue takes it.
    """
    stop, told = Event(), SimpleQueue[int]()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda number, _: told.put(number))
    Thread(target=_pass_on, args=(told, stop), name="told-to-end", daemon=True).start()
    return stop


@contextmanager
def sigterm_as_ctrl_c() -> Iterator[None]:
    """SIGTERM raises KeyboardInterrupt in the main thread, which enters this: what was made for a
    while is removed then, too.
    """
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _pass_on(told: SimpleQueue[int], stop: Event) -> None:
    told.get()
    stop.set()
