"""Compression of an export: gzip, which browsers and most programs for tracks undo themselves."""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Iterator

SUFFIX = ".gz"
_LEVEL = 6
_GZIP = 16 + zlib.MAX_WBITS  # its head instead of that of zlib: without a name and a time


def gzipped(content: Iterable[bytes]) -> Iterator[bytes]:
    """Compress a content; the same content gives the same bytes."""
    compressor = zlib.compressobj(_LEVEL, zlib.DEFLATED, _GZIP)
    for block in content:
        if part := compressor.compress(block):
            yield part
    yield compressor.flush()
