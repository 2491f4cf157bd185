"""Server of the station's queries for the journal (see docs/journal.md)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from edge.storage.journal.journal import Journal
from edge.storage.journal.schema import EVERYTHING, RAW, URGENT
from edge.storage.query_server import AnswerFunction, Parameters, QueryServer
from shared.messages import JournalChunk, JournalEntry, JournalIndex
from shared.sequence_set import Run

_MOST_BOOTS = 1000  # of a program that has started again and again there may be any number
_MAX_MESSAGES = 10_000
_REPLY_BYTES = 16_384
_MOST_REPLY_BYTES = _TOTAL_BYTES = 1_048_576  # a reply is made in memory
_ENTRY_OVERHEAD_BYTES = 24
_PRIORITIES = {"range": EVERYTHING, "urgent": URGENT, "raw": RAW}


class JournalServer(QueryServer):
    """Server of ``index``, ``urgent``, ``raw``, ``range`` and ``acknowledge`` under
    ``muster/v1/{unit}/journal/``.
    """

    def __init__(self, unit_id: str, journal: Journal) -> None:
        self._journal = journal
        functions: dict[str, AnswerFunction] = {
            "index": self._index,
            "acknowledge": self._acknowledge,
        }
        functions |= {part: partial(self._range, part) for part in _PRIORITIES}
        super().__init__(unit_id, "journal", functions)

    def _index(self, values: Parameters) -> Iterator[bytes]:
        newest = int(values.get("newest", _MOST_BOOTS))
        yield JournalIndex(self._journal.boots(max(0, min(newest, _MOST_BOOTS)))).to_bytes()

    def _acknowledge(self, values: Parameters) -> Iterator[bytes]:
        self._journal.acknowledge(int(values["epoch"]), int(values["to"]))
        return self._index(values)

    def _range(self, part: str, values: Parameters) -> Iterator[bytes]:
        boot_id, first, last = (int(values[name]) for name in ("epoch", "from", "to"))
        if not self._journal.has_boot(boot_id):
            return  # of another machine under this name: it may have what this one has not
        if boot_id == self._journal.boot_id:
            last = min(last, self._journal.last_seq)  # what is not written yet is not lost
        most = int(values.get("max", _MAX_MESSAGES))
        reply_bytes = min(int(values.get("bytes", _REPLY_BYTES)), _MOST_REPLY_BYTES)
        bytes_left = int(values.get("total", _TOTAL_BYTES))
        entries: list[JournalEntry] = []
        size = 0
        kept = self._journal.read(boot_id, first, last, _PRIORITIES[part])
        for count, entry in enumerate(kept, start=1):
            entries.append(entry)
            entry_bytes = len(entry.payload) + _ENTRY_OVERHEAD_BYTES
            size += entry_bytes
            bytes_left -= entry_bytes
            is_last = count >= most or bytes_left <= 0
            if is_last or size >= reply_bytes:
                yield _chunk(part, boot_id, Run(first, entry.seq), entries)
                first, entries, size = entry.seq + 1, [], 0
            if is_last:
                return
        if first <= last:
            yield _chunk(part, boot_id, Run(first, last), entries)


def _chunk(part: str, boot_id: int, run: Run, entries: list[JournalEntry]) -> bytes:
    urgent_only, raw_only = part == "urgent", part == "raw"
    return JournalChunk(boot_id, *run, tuple(entries), urgent_only, raw_only).to_bytes()
