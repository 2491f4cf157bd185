"""Gives the station pieces of the black box when it asks for them (see docs/recordings.md)."""

from __future__ import annotations

import hashlib
import logging
from collections.abc import Iterator
from pathlib import Path

from edge.data_folder import DataFolder
from edge.station_clock import StationClock
from shared.channels import ROOT
from shared.clock import NS_PER_S
from shared.mcap_log import segment_began_ns, segment_paths, segments_within
from shared.messages.recording import (
    RecordedFile,
    RecordingDigest,
    RecordingIndex,
    RecordingPiece,
)

logger = logging.getLogger(__name__)

MOST_PIECE_BYTES = 65_536
_HASHED_AT_ONCE = 1 << 20


class RecordingServer:
    """Serves ``index``, ``piece`` and ``digest`` under ``muster/v1/{unit}/recording/``."""

    def __init__(self, unit_id: str, folder: DataFolder, clock: StationClock) -> None:
        self._prefix = f"{ROOT}/{unit_id}/recording"
        self._folder = folder
        self._clock = clock

    @property
    def key_expression(self) -> str:
        return f"{self._prefix}/**"

    def replies(self, key: str, parameters: str, payload: bytes) -> Iterator[bytes]:
        """What a query is answered; nothing, and a line in the log, where it makes no sense."""
        del payload
        try:
            values = dict(pair.split("=", 1) for pair in parameters.split(";") if pair)
            match key.removeprefix(self._prefix + "/"):
                case "index":
                    yield self._index(int(values["from"]), int(values["to"])).to_bytes()
                case "piece":
                    offset, length = int(values["offset"]), int(values["length"])
                    yield self._piece(values["path"], offset, length).to_bytes()
                case "digest":
                    yield self._digest(values["path"], int(values["size"])).to_bytes()
                case _:
                    logger.warning("asked for %s, which a recording does not have", key)
        except (KeyError, ValueError, OverflowError) as error:
            logger.warning("a question for a recording makes no sense: %r (%r)", parameters, error)
        except OSError as error:
            logger.error("the recording cannot be read: %s", error)

    def _index(self, from_ns: int, to_ns: int) -> RecordingIndex:
        """Times are station time; the black box goes by the machine's."""
        ahead_ns = round(self._clock.machine_ahead_s() * NS_PER_S)
        found: list[Path] = []
        first_ns = 0
        for boot in sorted(self._folder.black_box.glob("*/")):
            segments = segment_paths(boot)
            if not segments:
                continue
            first_ns = first_ns or segment_began_ns(segments[0]) - ahead_ns
            within = segments_within(segments, from_ns + ahead_ns, to_ns + ahead_ns)
            found += [one for one in within if one.stat().st_mtime_ns >= from_ns + ahead_ns]
        if found:
            found += sorted(self._folder.calibrations.glob("*.toml"))
        return RecordingIndex(
            tuple(RecordedFile(self._name_of(one), one.stat().st_size) for one in found), first_ns
        )

    def _piece(self, name: str, offset: int, length: int) -> RecordingPiece:
        path = self._path_of(name)
        if path is None:
            return RecordingPiece(offset, b"", b"", gone=True)
        with path.open("rb") as file:
            file.seek(offset)
            data = file.read(max(0, min(length, MOST_PIECE_BYTES)))
        return RecordingPiece(offset, data, hashlib.sha256(data).digest())

    def _digest(self, name: str, size_bytes: int) -> RecordingDigest:
        path = self._path_of(name)
        if path is None:
            return RecordingDigest(0, b"")
        return RecordingDigest(size_bytes, sha256_of(path, size_bytes))

    def _name_of(self, path: Path) -> str:
        return f"{path.parent.name}/{path.name}"

    def _path_of(self, name: str) -> Path | None:
        """Only what is in the black box or among the calibrations, whatever was asked for."""
        folder, _, file = name.partition("/")
        if folder == self._folder.calibrations.name:
            found = list(self._folder.calibrations.glob("*.toml"))
        else:
            boots = {boot.name: boot for boot in self._folder.black_box.glob("*/")}
            found = segment_paths(boots[folder]) if folder in boots else []
        return next((path for path in found if path.name == file), None)


def sha256_of(path: Path, size_bytes: int) -> bytes:
    """Of the first ``size_bytes`` of a file; raises ValueError where it is shorter."""
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
