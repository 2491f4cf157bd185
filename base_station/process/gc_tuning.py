"""Settings of Python's interpreter for a station.

The collector of cycles is set for a program that holds many objects and makes hardly a cycle.  By
default it examines all live objects again and again: a tenth of the engine's time, in pauses of a
tenth of a second in which no message is received or sent.

Threads switch ten times as often as by default.  A message from the bus to a console passes three
threads that need the interpreter for a moment only, and each would wait for five milliseconds while
the engine has much to do.

Large blocks, such as a saved state, have memory of their own.  Otherwise small blocks would fill a
part of it and leave holes that nothing fits into, so that the station's memory would grow.
"""

from __future__ import annotations

import ctypes
import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_TURN_S = 0.0005
_NEW_OBJECTS = 50_000  # made and not gone, after which the young are looked at
_YOUNG, _OLD = 20, 20  # such looks, after which older ones are
_LARGE_BYTES = 1 << 20  # a block of its own, given back to the system when it is free
_MMAP_THRESHOLD = -3  # as the C library calls it
_GIVEN_BACK_BYTES = 1 << 16


@contextmanager
def paused() -> Iterator[None]:
    """While modules are loaded, of which nothing goes again: looking costs a fifth of that.

    Nor is what they made looked at later, for a station's start would take longer by that.
    """
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


def configure() -> None:
    """Set the interpreter; to be called when the program begins."""
    gc.set_threshold(_NEW_OBJECTS, _YOUNG, _OLD)
    sys.setswitchinterval(_TURN_S)
    _have_own_blocks(_LARGE_BYTES)


def return_free_memory() -> None:
    """Give the memory of large blocks back to the system as soon as it is free; for a program of
    large arrays that come and go.
    """
    _have_own_blocks(_GIVEN_BACK_BYTES)


def _have_own_blocks(large_bytes: int) -> None:
    set_memory = getattr(ctypes.CDLL(None), "mallopt", None)  # missing in some C libraries
    if set_memory is not None:
        set_memory(_MMAP_THRESHOLD, large_bytes)


def freeze() -> None:
    """Exclude present objects from collection, as they stay; to be called when the program is set
    up.
    """
    gc.collect()
    gc.freeze()


def unfreeze() -> None:
    """Include them again; to be called when the program is to be set up anew, as its objects may
    go.
    """
    gc.unfreeze()
