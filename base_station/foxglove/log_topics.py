"""Topics and units of a log."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from shared.channels import POSITION, parse_key
from shared.errors import UnknownChannelError
from shared.mcap_log import SegmentReader


def topics_in(segments: Iterable[Path]) -> set[str]:
    """Topics of a log, including those made for Foxglove; an incomplete segment is read for
    them.
    """
    topics: set[str] = set()
    for path in segments:
        with SegmentReader(path) as reader:
            topics |= set(
                reader.topic_counts or (key for _, key, _ in reader.records(derived=True))
            )
    return topics


def units_among(topics: Iterable[str]) -> set[str]:
    """Ids of the units that have a position among ``topics``."""
    units = set()
    for topic in topics:
        try:
            unit_id, channel = parse_key(topic)
        except UnknownChannelError:  # of a later version, or made for Foxglove
            continue
        if channel is POSITION:
            units.add(unit_id)
    return units
