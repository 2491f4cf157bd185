"""Makes a segment again with other records in place of some."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path

from shared.mcap_log.foreign_files import identity_in_log
from shared.mcap_log.reading import LogRecord, SegmentReader
from shared.mcap_log.recovery import TORN
from shared.mcap_log.segment_exchange import exchange_segment
from shared.mcap_log.writing import Segment, SegmentPolicy

Replace = Callable[[LogRecord], Sequence[LogRecord]]


def rewrite_segment(
    path: Path,
    replace: Replace,
    rest: Callable[[], Sequence[LogRecord]] = tuple,
    on_damage: Callable[[str], None] = lambda _: None,
) -> int:
    """Give the number of records that changed; where none did, the file is left as it is.

    ``rest`` gives the records behind the last one.  ``on_damage`` is called with a sentence for
    each part that could not be read, and so is not in a new file; where one of the three raises,
    the file stays, too.

    The segment is exchanged as a whole or not at all; what a reader has open stays as it was.
    No process may write to it meanwhile.  Raises LogError when the disk refuses.
    """
    rewritten = partial(_rewritten, path, replace, rest, on_damage)
    return exchange_segment(path, rewritten, attempted="written")


def write_segment_like(model: Path, path: Path, records: Iterable[LogRecord]) -> bool:
    """Make a complete segment of the same log as ``model``; False, and no file, where there are no
    records.  Raises OSError.
    """
    segment = Segment(path, SegmentPolicy().chunk_bytes, identity_in_log(model).revised())
    try:
        for t_ns, key, payload in records:
            segment.add(t_ns, key, payload)
        if not segment.end_ns:
            return False
        segment.finish()
        segment.file.sync()
    finally:
        segment.file.close()
    return True


def remove_torn(folder: Path) -> int:
    """Remove what recoveries kept of torn segments; the number of files."""
    torn = list(folder.glob(f"*.mcap{TORN}*"))
    for path in torn:
        path.unlink()
    return len(torn)


def _rewritten(
    path: Path,
    replace: Replace,
    rest: Callable[[], Sequence[LogRecord]],
    on_damage: Callable[[str], None],
    making: Path,
) -> int:
    changed = 0
    segment = Segment(making, SegmentPolicy().chunk_bytes, identity_in_log(path).revised())
    try:
        with SegmentReader(path) as reader:
            for record in reader.records(derived=True):
                instead = replace(record)
                changed += len(instead) != 1 or instead[0] != record
                for t_ns, key, payload in instead:
                    segment.add(t_ns, key, payload)
            for note in reader.damage:
                on_damage(note)
        for t_ns, key, payload in rest():
            changed += 1
            segment.add(t_ns, key, payload)
        segment.finish()
        segment.file.sync()
    finally:
        segment.file.close()
    return changed
