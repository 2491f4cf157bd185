"""The log: folders of MCAP segments, written so that a crash costs half a second at most and
read as they are, complete, growing, torn or damaged.  The only package that imports ``mcap``.
"""

from __future__ import annotations

from shared.mcap_log.byte_ranges import ChunkRange, SegmentRanges, byte_ranges_of
from shared.mcap_log.enclosures import AttachedFile, Enclosures, enclosures_of, read_attached
from shared.mcap_log.folder import (
    missing_segments,
    segment_began_ns,
    segment_number,
    segment_path,
    segment_paths,
    segments_within,
)
from shared.mcap_log.foreign_files import (
    foreign_in_words,
    identity_in_log,
    is_foreign_note,
    own_segments,
)
from shared.mcap_log.identity import SegmentIdentity, identity_of
from shared.mcap_log.log_membership import log_id_of, segments_of_one_log
from shared.mcap_log.packing import can_be_packed, pack_segment
from shared.mcap_log.ranged_file import FetchRange, RangedSegmentFile
from shared.mcap_log.reading import LogRecord, SegmentReader, read_log
from shared.mcap_log.recovery import Recovery, recover_log
from shared.mcap_log.rewriting import remove_torn, rewrite_segment, write_segment_like
from shared.mcap_log.schemas import (
    DELTA_TOPIC,
    PLAN_TOPIC,
    SNAPSHOT_TOPIC,
    TRAIL_TOPIC,
    audio_topic,
    channel_of_audio,
    descriptor_set,
    is_console,
    is_derived,
    location_topic,
    log_topic,
    wire_type_of,
)
from shared.mcap_log.segment_rebuild import RebuiltSegment
from shared.mcap_log.tail import LogTail
from shared.mcap_log.writing import (
    Segment,
    SegmentInfo,
    SegmentPolicy,
    SegmentState,
    SegmentWriter,
)

__all__ = [
    "DELTA_TOPIC",
    "PLAN_TOPIC",
    "SNAPSHOT_TOPIC",
    "TRAIL_TOPIC",
    "AttachedFile",
    "ChunkRange",
    "Enclosures",
    "FetchRange",
    "LogRecord",
    "LogTail",
    "RangedSegmentFile",
    "RebuiltSegment",
    "Recovery",
    "Segment",
    "SegmentIdentity",
    "SegmentInfo",
    "SegmentPolicy",
    "SegmentRanges",
    "SegmentReader",
    "SegmentState",
    "SegmentWriter",
    "audio_topic",
    "byte_ranges_of",
    "can_be_packed",
    "channel_of_audio",
    "descriptor_set",
    "enclosures_of",
    "foreign_in_words",
    "identity_in_log",
    "identity_of",
    "is_console",
    "is_derived",
    "is_foreign_note",
    "location_topic",
    "log_id_of",
    "log_topic",
    "missing_segments",
    "own_segments",
    "pack_segment",
    "read_attached",
    "read_log",
    "recover_log",
    "remove_torn",
    "rewrite_segment",
    "segment_began_ns",
    "segment_number",
    "segment_path",
    "segment_paths",
    "segments_of_one_log",
    "segments_within",
    "wire_type_of",
    "write_segment_like",
]
