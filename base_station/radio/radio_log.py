"""Audio of the radio channels on disk: a log of its own for each, beside the station's log."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import closing
from functools import lru_cache
from heapq import merge
from itertools import pairwise
from pathlib import Path

from base_station.radio.ogg import ogg_opus
from base_station.radio.opus import (
    NS_PER_SAMPLE_3,
    SILENT_FRAME_SAMPLES,
    SILENT_FRAMES_MAX,
    duration_ns,
    silence,
)
from base_station.radio.packets import Packet, packet_of
from base_station.radio.spans import ChannelSpans, joined, spans_of
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import LogError
from shared.mcap_log import (
    LogRecord,
    SegmentReader,
    SegmentWriter,
    audio_topic,
    channel_of_audio,
    remove_torn,
    rewrite_segment,
    segment_began_ns,
    segment_paths,
    segments_within,
)

_SILENT_FRAME_NS = SILENT_FRAME_SAMPLES * NS_PER_SAMPLE_3 // 3
_PACKET_MAX_NS = NS_PER_S // 8  # a packet that began before a window reaches into it
_KNOWN_SEGMENTS = 4_096


class RadioLog:
    """``folder`` has one folder for each channel."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def channels(self) -> tuple[str, ...]:
        """Names of those of which something is recorded, in order."""
        if not self.folder.is_dir():
            return ()
        return tuple(sorted(one.name for one in self.folder.iterdir() if segment_paths(one)))

    def spans(self, channel: str, from_ns: int, until_ns: int) -> ChannelSpans:
        """Within a window of station time.  Raises LogError where the disk does not give it."""
        paths = segments_within(segment_paths(self.folder / channel), from_ns, until_ns)
        return joined(map(_segment_spans, _existing(paths))).within(from_ns, until_ns)

    def packets(self, channel: str, from_ns: int, until_ns: int) -> Iterator[Packet]:
        """Those that begin in a window of station time.  Raises LogError."""
        paths = segments_within(segment_paths(self.folder / channel), from_ns, until_ns)
        for path in _existing(paths):
            with SegmentReader(path) as segment:
                yield from _packets_in(segment, from_ns, until_ns)

    def audio(self, channel: str, from_ns: int, until_ns: int) -> bytes:
        """A window as an Ogg file with a length of just that; gaps are silent.  Raises LogError."""
        packets = self.packets(channel, from_ns - _PACKET_MAX_NS, until_ns)
        return ogg_opus(_filled(packets, from_ns, until_ns))

    def records(self, from_ns: int, until_ns: int) -> Iterator[LogRecord]:
        """Those of all channels, in the order of time.  Raises LogError."""
        return merge(
            *(self._records_of(one, from_ns, until_ns) for one in self.channels()),
            key=lambda record: record[0],
        )

    def _records_of(self, channel: str, from_ns: int, until_ns: int) -> Iterator[LogRecord]:
        topics = {audio_topic(channel)}
        paths = segments_within(segment_paths(self.folder / channel), from_ns, until_ns)
        for path in _existing(paths):
            with SegmentReader(path) as segment:
                yield from segment.records(from_ns, until_ns, topics, derived=True)

    def take_from(self, file: SegmentReader) -> None:
        """Lay out the audio of a file that has all channels (``records``) as here."""
        for topic in sorted(file.topic_counts or ()):
            channel = channel_of_audio(topic)
            if channel is None:
                continue
            with closing(SegmentWriter(self.folder / channel)) as writer:
                for record in file.records(keys={topic}, derived=True):
                    writer.write(*record)

    def remove_before(self, channel: str, t_ns: int) -> int:
        """Delete segments that are older as a whole; the number of them.  Raises OSError.

        The last one, which may be open, stays.
        """
        paths = segment_paths(self.folder / channel)
        old = [path for path, following in pairwise(paths) if segment_began_ns(following) <= t_ns]
        for path in old:
            path.unlink(missing_ok=True)
        if old:
            remove_torn(self.folder / channel)
        return len(old)

    def erase(self, from_ns: int, until_ns: int) -> int:
        """Take a window out of all channels; the number of packets.  No thread may be
        writing to the segments that have some of it.  Raises LogError.
        """
        erased = 0
        for channel in self.channels():
            folder = self.folder / channel
            remove_torn(folder)
            for path in segments_within(segment_paths(folder), from_ns, until_ns):
                erased += rewrite_segment(
                    path, lambda record: () if from_ns <= record[0] < until_ns else (record,)
                )
        return erased


def _existing(paths: Iterable[Path]) -> Iterator[Path]:
    """Those that are not deleted meanwhile."""
    return (path for path in paths if path.exists())


def _packets_in(segment: SegmentReader, from_ns: int, until_ns: int) -> Iterator[Packet]:
    topics = {audio_topic(segment.path.parent.name)}
    for t_ns, _, payload in segment.records(from_ns, until_ns, topics, derived=True):
        if (packet := packet_of(t_ns, payload)) is not None:
            yield packet


def _segment_spans(path: Path) -> ChannelSpans:
    try:
        file = path.stat()
    except OSError as error:
        raise LogError(
            coded(
                "radio-file-unreadable",
                "{path} cannot be read ({error}): check the disk",
                path=str(path),
                error=str(error.strerror),
            )
        ) from error
    return _read_spans(path, file.st_ino, file.st_mtime_ns, file.st_size)


@lru_cache(_KNOWN_SEGMENTS)
def _read_spans(path: Path, _inode: int, _written_ns: int, _size: int) -> ChannelSpans:
    """Another file, or a longer one, is another key."""
    with SegmentReader(path) as segment:
        return spans_of(_packets_in(segment, 0, 1 << 63))


def _filled(packets: Iterable[Packet], from_ns: int, until_ns: int) -> Iterator[bytes]:
    """Each at its place, within half its length; silence where there is none."""
    at_ns = from_ns
    for packet in packets:
        length_ns = duration_ns(packet.data)
        if packet.t_ns < at_ns - length_ns // 2:
            continue
        for filling in _silences(packet.t_ns - at_ns):
            yield filling
            at_ns += duration_ns(filling)
        yield packet.data
        at_ns += length_ns
    yield from _silences(until_ns - at_ns)


def _silences(length_ns: int) -> Iterator[bytes]:
    """Packets of silence that are as long, but for less than 20 ms."""
    frames = max(length_ns, 0) // _SILENT_FRAME_NS
    while frames > 0:
        some = min(frames, SILENT_FRAMES_MAX)
        yield silence(some)
        frames -= some
