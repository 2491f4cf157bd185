"""Enclosures of an MCAP file: its metadata, and the files that are attached to its messages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mcap.exceptions import McapError
from mcap.reader import make_reader

from shared.mcap_log.container import NONSENSE


@dataclass(frozen=True, slots=True)
class Enclosures:
    """By name; of the same name the last one."""

    metadata: Mapping[str, Mapping[str, str]]
    attachments: Mapping[str, bytes]


def enclosures_of(path: Path) -> Enclosures:
    """Nothing where the file is no complete MCAP file.  Raises OSError where it cannot be read."""
    try:
        with path.open("rb") as file:
            reader = make_reader(file, validate_crcs=True)
            metadata = {one.name: one.metadata for one in reader.iter_metadata()}
            attachments = {one.name: one.data for one in reader.iter_attachments()}
    except (McapError, *NONSENSE):
        return Enclosures({}, {})
    return Enclosures(metadata, attachments)
