"""Raw recordings as a station finds them: folders of segments, each of one boot of a unit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import msgspec

from shared.channels import DESCRIPTION, parse_key
from shared.codec import header_of
from shared.errors import RecordingError, UnknownChannelError
from shared.mcap_log import SegmentReader, read_log, segment_paths
from shared.messages import STATION_ID

Run = tuple[str, int]  # of a program: sender, and its boot


class BlackBoxBoot(msgspec.Struct, frozen=True):
    """Recording of one boot; log times of the black box."""

    path: Path
    unit_id: str
    boot_id: int
    from_ns: int
    until_ns: int
    size_bytes: int

    @property
    def run(self) -> Run:
        return self.unit_id, self.boot_id


def boots_below(folder: Path) -> Iterator[BlackBoxBoot]:
    """Boots in a folder and in those below it, by path; other folders of segments are left out."""
    for path in sorted({folder, *(one for one in folder.rglob("*") if one.is_dir())}):
        if segment_paths(path):
            try:
                yield read_boot(path)
            except RecordingError:
                continue


def boots_in_files(paths: Iterable[Path]) -> Iterator[BlackBoxBoot]:
    """Boots that a person names.  Raises RecordingError where there is none."""
    for path in paths:
        found = [read_boot(path)] if segment_paths(path) else list(boots_below(path))
        if not found:
            raise RecordingError(
                f"{path} has no raw recording of a unit; give the folder of a boot, of a unit, or "
                "of several units"
            )
        yield from found


def read_boot(path: Path) -> BlackBoxBoot:
    """The boot in a folder of segments.  Raises RecordingError where it is not a boot of a unit."""
    unit_id, boot_id = _sender(path)
    times = []
    for segment in segment_paths(path):
        with SegmentReader(segment) as reader:
            info = reader.info()
        if info.messages:
            times += [info.start_ns, info.end_ns]
    size_bytes = sum(one.stat().st_size for one in segment_paths(path))
    return BlackBoxBoot(path, unit_id, boot_id, min(times), max(times), size_bytes)


def _sender(path: Path) -> Run:
    """Unit and boot, from the description that each segment begins with."""
    for _, key, payload in read_log(path):
        try:
            sender, channel = parse_key(key)
        except UnknownChannelError:
            continue
        header = header_of(payload)
        if sender == STATION_ID or (header is not None and header.seq):
            break  # a log of a station, or a journal: recordings of a unit have no numbers
        if channel is DESCRIPTION and header is not None:
            return sender, header.boot_id
    raise RecordingError(f"{path} is no raw recording of a unit")
