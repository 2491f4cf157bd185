"""Server of pieces of the black box for the station (see docs/recordings.md)."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

from edge.clocks.station import StationClock
from edge.storage.black_box.station_time import read_clock_offset
from edge.storage.data_folder import UnitDataFolder
from edge.storage.query_server import Parameters, QueryServer
from shared.clock import NS_PER_S
from shared.mcap_log import (
    SegmentPolicy,
    SegmentReader,
    segment_began_ns,
    segment_paths,
    segments_within,
)
from shared.messages.recording import (
    RecordedFile,
    RecordingDigest,
    RecordingIndex,
    RecordingPiece,
)

MOST_PIECE_BYTES = 65_536
_HASHED_AT_ONCE = 1 << 20
_ON_DISK_NS = 2 * NS_PER_S  # until what is recorded can be read
_LONGEST_NS = round(SegmentPolicy().segment_s * NS_PER_S) + NS_PER_S  # names have whole seconds


class RecordingServer(QueryServer):
    """Server of ``index``, ``piece`` and ``digest`` under ``muster/v1/{unit}/recording/``."""

    def __init__(self, unit_id: str, folder: UnitDataFolder, clock: StationClock) -> None:
        self._folder = folder
        self._clock = clock
        functions = {"index": self._index, "piece": self._piece, "digest": self._digest}
        super().__init__(unit_id, "recording", functions)

    def _index(self, values: Parameters) -> Iterator[bytes]:
        """Serve the index.  Times are station time; each boot's recording goes by the machine's
        as it was then.
        """
        from_ns, to_ns = int(values["from"]), int(values["to"])
        now_ahead_ns = round(self._clock.machine_ahead_s() * NS_PER_S)
        found: list[Path] = []
        began_ns: list[int] = []
        for boot in sorted(self._folder.black_box.glob("*/")):
            segments = segment_paths(boot)
            if not segments:
                continue
            known_ns = read_clock_offset(boot)
            ahead_ns = now_ahead_ns if known_ns is None else known_ns
            began_ns.append(segment_began_ns(segments[0]) - ahead_ns)
            within = segments_within(segments, from_ns + ahead_ns, to_ns + ahead_ns)
            found += [
                one
                for one in within
                if one != segments[-1] or not _ends_before(one, from_ns + ahead_ns)
            ]
        first_ns = min(began_ns, default=0)
        if found:
            found += sorted(self._folder.calibrations.glob("*.toml"))
        files = tuple(RecordedFile(self._name_of(one), one.stat().st_size) for one in found)
        yield RecordingIndex(files, first_ns).to_bytes()

    def _piece(self, values: Parameters) -> Iterator[bytes]:
        offset, length = int(values["offset"]), int(values["length"])
        path = self._path_of(values["path"])
        if path is None:
            yield RecordingPiece(offset, b"", b"", gone=True).to_bytes()
            return
        with path.open("rb") as file:
            file.seek(offset)
            data = file.read(max(0, min(length, MOST_PIECE_BYTES)))
        yield RecordingPiece(offset, data, hashlib.sha256(data).digest()).to_bytes()

    def _digest(self, values: Parameters) -> Iterator[bytes]:
        size_bytes = int(values["size"])
        path = self._path_of(values["path"])
        digest = b"" if path is None else sha256_of(path, size_bytes)
        yield RecordingDigest(0 if path is None else size_bytes, digest).to_bytes()

    def _name_of(self, path: Path) -> str:
        return f"{path.parent.name}/{path.name}"

    def _path_of(self, name: str) -> Path | None:
        """Return a path in the black box or among the calibrations only, whatever was asked for."""
        folder, _, file = name.partition("/")
        if folder == self._folder.calibrations.name:
            found = list(self._folder.calibrations.glob("*.toml"))
        else:
            boots = {boot.name: boot for boot in self._folder.black_box.glob("*/")}
            found = segment_paths(boots[folder]) if folder in boots else []
        return next((path for path in found if path.name == file), None)


def _ends_before(path: Path, from_ns: int) -> bool:
    """Return True if a segment, which may still be written, has no record at this log time or
    later.

    Its name is enough in most cases.  A torn segment has to be read to its end, and a unit that is
    switched off without a stop has one of each boot: reading all of them would take too long.
    """
    if segment_began_ns(path) + _LONGEST_NS < from_ns:
        return True
    with SegmentReader(path) as reader:
        return reader.info().end_ns + _ON_DISK_NS < from_ns


def sha256_of(path: Path, size_bytes: int) -> bytes:
    """Return the digest of the first ``size_bytes`` of a file; raises ValueError where it is
    shorter.
    """
    digest = hashlib.sha256()
    left = size_bytes
    with path.open("rb") as file:
        while left > 0:
            data = file.read(min(left, _HASHED_AT_ONCE))
            if not data:
                raise ValueError(f"{path.name} has only {size_bytes - left} bytes")
            digest.update(data)
            left -= len(data)
    return digest.digest()
