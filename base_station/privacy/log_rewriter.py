"""Rewrites the segments of a log, and of logs set aside beside it, without the erased records."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from base_station.core.erasure.erasure import CaptureClocks, Erasure
from base_station.core.erasure.erasure_order import ErasureOrder, OrderedPart
from base_station.core.erasure.redaction import Redactor
from base_station.privacy.erasure_progress import ErasureProgress, Progress
from base_station.privacy.log_files import LogFiles, LogReading, actions_in
from base_station.storage.db.records import Records
from base_station.storage.segment_index import segment_row
from shared.coded_text import coded
from shared.errors import StoreError
from shared.mcap_log import SegmentReader, remove_torn, rewrite_segment

RepairPending = Callable[[Path, str], bool]  # receives the damage in a segment of the log


class LogRewriter:
    """Rewriter of a log, for one thread at a time; a running station logs on in a new segment."""

    def __init__(self, log: LogFiles, records: Records, is_repair_pending: RepairPending) -> None:
        """``is_repair_pending``: True where the lost part of a segment is about to be fetched from
        the other station.
        """
        self._log = log
        self._reading = LogReading(log)
        self._records = records
        self._is_repair_pending = is_repair_pending

    def rewrite(
        self,
        erasure: Erasure,
        order: ErasureOrder | None,
        on_progress: Progress,
        progress: ErasureProgress,
    ) -> None:
        """Rewrite every segment; of the log itself, only the part before ``order``."""
        segments = [*self._log.complete_segments(), *self._reading.set_aside()]
        clocks, ordered, whole = CaptureClocks(), OrderedPart(order), OrderedPart(None)
        progress.files += sum(
            map(remove_torn, {self._log.folder, *(path.parent for path in segments)})
        )
        for number, path in enumerate(segments):
            on_progress(number / len(segments))
            redactor = Redactor(erasure, clocks, erasure.inserted_in(actions_in(path)))
            shared = ordered if path.parent == self._log.folder else whole
            replace = partial(shared.redacted, redactor=redactor)
            damage: list[str] = []
            with self._log.rewriting:
                changed = rewrite_segment(path, replace, on_damage=self._noting(path, damage))
            for part in damage:
                progress.note_damage(part, written_anew=changed > 0)
            progress.records += changed
            if changed:
                progress.files += 1
                self._log.note_rewritten(path)
                self._note_in_table(path)
        on_progress(1.0)

    def _note_in_table(self, path: Path) -> None:
        """Note the new counts of a segment, so that erased records do not count as missing."""
        if path.parent == self._log.folder:
            with SegmentReader(path) as segment:
                self._records.put_segments([segment_row(segment.info())])

    def _noting(self, path: Path, damage: list[str]) -> Callable[[str], None]:
        """Callback that notes damage, as a rewritten segment does not show it any more.

        The callback raises StoreError where the segment is about to be repaired.
        """

        def note(part: str) -> None:
            if path.parent == self._log.folder and self._is_repair_pending(path, part):
                raise StoreError(
                    coded(
                        "erasure-after-mending",
                        "{part}; what is lost is fetched from the other station first",
                        part=part,
                    )
                )
            damage.append(part)

        return note
