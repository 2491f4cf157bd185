"""Answers of a unit's journal (see docs/journal.md)."""

from __future__ import annotations

import msgspec
from google.protobuf.message import DecodeError

from shared.errors import WireError
from shared.messages.muster.v1 import journal_pb2


class JournalEntry(msgspec.Struct, frozen=True):
    seq: int
    suffix: str  # the key after ``muster/v1/{unit}/``
    payload: bytes  # as it was published


class JournalChunk(msgspec.Struct, frozen=True):
    """A run of one boot's journal.

    It accounts for every sequence number from ``from_seq`` to ``to_seq``: a number without
    an entry is no longer kept, or never was; in one that is ``urgent_only``, all that is
    known of it is that it is no alert.
    """

    boot_id: int
    from_seq: int
    to_seq: int
    entries: tuple[JournalEntry, ...]
    urgent_only: bool = False
    raw_only: bool = False  # the same, of raw samples

    def to_bytes(self) -> bytes:
        wire = journal_pb2.JournalChunk(
            boot_id=self.boot_id,
            from_seq=self.from_seq,
            to_seq=self.to_seq,
            urgent_only=self.urgent_only,
            raw_only=self.raw_only,
        )
        for entry in self.entries:
            wire.entries.add(seq=entry.seq, suffix=entry.suffix, payload=entry.payload)
        return wire.SerializeToString()

    @staticmethod
    def from_bytes(payload: bytes) -> JournalChunk:
        """Raises WireError when ``payload`` is no chunk."""
        wire = journal_pb2.JournalChunk()
        try:
            wire.ParseFromString(payload)
        except DecodeError as error:
            raise WireError(f"{len(payload)} bytes are no journal chunk: {error}") from error
        return JournalChunk(
            boot_id=wire.boot_id,
            from_seq=wire.from_seq,
            to_seq=wire.to_seq,
            entries=tuple(
                JournalEntry(entry.seq, entry.suffix, entry.payload) for entry in wire.entries
            ),
            urgent_only=wire.urgent_only,
            raw_only=wire.raw_only,
        )


class JournalBoot(msgspec.Struct, frozen=True):
    boot_id: int
    first_seq: int
    last_seq: int
    acknowledged_seq: int  # the station has everything up to here; 0 nothing
    started_utc_ns: int


class JournalIndex(msgspec.Struct, frozen=True):
    """Boots that a unit can still serve, oldest first."""

    boots: tuple[JournalBoot, ...]

    def to_bytes(self) -> bytes:
        wire = journal_pb2.JournalIndex()
        for boot in self.boots:
            wire.boots.add(
                boot_id=boot.boot_id,
                first_seq=boot.first_seq,
                last_seq=boot.last_seq,
                acknowledged_seq=boot.acknowledged_seq,
                started_utc_ns=boot.started_utc_ns,
            )
        return wire.SerializeToString()

    @staticmethod
    def from_bytes(payload: bytes) -> JournalIndex:
        """Raises WireError when ``payload`` is no index."""
        wire = journal_pb2.JournalIndex()
        try:
            wire.ParseFromString(payload)
        except DecodeError as error:
            raise WireError(f"{len(payload)} bytes are no journal index: {error}") from error
        return JournalIndex(
            tuple(
                JournalBoot(
                    boot.boot_id,
                    boot.first_seq,
                    boot.last_seq,
                    boot.acknowledged_seq,
                    boot.started_utc_ns,
                )
                for boot in wire.boots
            )
        )
