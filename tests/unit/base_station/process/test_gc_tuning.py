"""Garbage collection and memory settings of the station's process."""

from __future__ import annotations

import subprocess
import sys

import pytest

LARGE = """
import ctypes
from base_station.process import gc_tuning

libc = ctypes.CDLL(None)
if not hasattr(libc, "mallinfo2"):
    raise SystemExit(77)

class Info(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in (
        "arena", "ordblks", "smblks", "hblks", "hblkhd",
        "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost",
    )]

libc.mallinfo2.restype = Info
gc_tuning.configure()
bytearray(16 << 20)  # made and freed: the C library learns from it
before = libc.mallinfo2().hblks
held = bytearray(4 << 20)
raise SystemExit(libc.mallinfo2().hblks - before != 1)
"""


@pytest.mark.slow
def test_large_freed_memory_is_returned_to_the_system() -> None:
    """It has a block of its own, not one among small ones."""
    ended = subprocess.run([sys.executable, "-c", LARGE], timeout=60.0, check=False)
    if ended.returncode == 77:
        pytest.skip("this C library does not tell what it has of the system")
    assert ended.returncode == 0
