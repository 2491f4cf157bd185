"""Signals that end a program: Ctrl-C, and what a service manager sends."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from queue import SimpleQueue
from threading import Event, Thread


def end_requested() -> Event:
    """Event that the first SIGINT or SIGTERM sets; for the main thread to call.

    Not set by the handler itself: that runs between any two steps of the main thread, which may
    hold the event's lock just then, and would wait for itself for ever.  A queue takes it.
    """
    stop, received = Event(), SimpleQueue[int]()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda number, _: received.put(number))
    Thread(target=_forward_signal, args=(received, stop), name="end-signals", daemon=True).start()
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


def _forward_signal(received: SimpleQueue[int], stop: Event) -> None:
    received.get()
    stop.set()
