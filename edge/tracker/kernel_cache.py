"""A name for the state of the compiled kernels' sources.

numba's cache on disk looks at the time stamp of the file that holds a function, not
at the files of the functions it calls.  So only the entry points ``admit`` and ``work``
are cached, and the types of what they take carry this digest of all sources: an
edit or an upgrade anywhere compiles anew.
"""

from __future__ import annotations

import hashlib
from pathlib import Path


def source_digest() -> str:
    """Return eight hexadecimal digits of this package's sources."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:8]


SOURCES = f"sources_{source_digest()}"
