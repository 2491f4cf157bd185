"""Python's collector of cycles, set for a program that holds much and makes hardly a cycle.

As it comes it looks at everything that lives again and again: a tenth of the drive's time, in
pauses of a tenth of a second in which nobody is heard or told anything.
"""

from __future__ import annotations

import gc

_NEW_OBJECTS = 50_000  # made and not gone, after which the young are looked at
_YOUNG, _OLD = 20, 20  # such looks, after which older ones are


def relax() -> None:
    """When the program begins."""
    gc.set_threshold(_NEW_OBJECTS, _YOUNG, _OLD)


def settle() -> None:
    """When it is made: what lives now stays, and need not be looked at again."""
    gc.unfreeze()
    gc.collect()
    gc.freeze()
