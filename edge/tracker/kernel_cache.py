"""Digest of the sources of the compiled kernels, as a part of their types.

numba's cache on disk compares the time stamp of the file that holds a function, not of the files of
the functions it calls.  So only the functions that Python calls are cached, and the types of their
arguments carry this digest of all sources: an edit or an upgrade anywhere compiles again.
"""

from __future__ import annotations

import hashlib
from pathlib import Path


def source_digest() -> str:
    """Return eight hexadecimal digits of the sources of this package and all below it."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("**/*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:8]


SOURCES = f"sources_{source_digest()}"
