"""Answers of a unit that is asked for its black box (see docs/recordings.md)."""

from __future__ import annotations

from typing import TypeVar

import msgspec
from google.protobuf.message import DecodeError
from google.protobuf.message import Message as WireMessage

from shared.errors import WireError
from shared.messages.muster.v1 import recording_pb2

W = TypeVar("W", bound=WireMessage)


class RecordedFile(msgspec.Struct, frozen=True):
    path: str  # below the unit's own folder; parts joined by "/"
    size_bytes: int


class RecordingIndex(msgspec.Struct, frozen=True):
    files: tuple[RecordedFile, ...]
    first_ns: int  # station time from which anything is kept at all; 0: nothing is

    def to_bytes(self) -> bytes:
        wire = recording_pb2.RecordingIndex(first_ns=self.first_ns)
        for one in self.files:
            wire.files.add(path=one.path, size_bytes=one.size_bytes)
        return wire.SerializeToString()

    @staticmethod
    def from_bytes(payload: bytes) -> RecordingIndex:
        """Raises WireError when ``payload`` is no index."""
        wire = _parsed(recording_pb2.RecordingIndex(), payload)
        files = tuple(RecordedFile(one.path, one.size_bytes) for one in wire.files)
        return RecordingIndex(files, wire.first_ns)


class RecordingPiece(msgspec.Struct, frozen=True):
    offset: int
    data: bytes
    sha256: bytes  # of ``data``
    gone: bool = False  # there is no such file any more

    def to_bytes(self) -> bytes:
        return recording_pb2.RecordingPiece(
            offset=self.offset, data=self.data, sha256=self.sha256, gone=self.gone
        ).SerializeToString()

    @staticmethod
    def from_bytes(payload: bytes) -> RecordingPiece:
        """Raises WireError when ``payload`` is no piece."""
        wire = _parsed(recording_pb2.RecordingPiece(), payload)
        return RecordingPiece(wire.offset, wire.data, wire.sha256, wire.gone)


class RecordingDigest(msgspec.Struct, frozen=True):
    size_bytes: int
    sha256: bytes  # of the file up to there

    def to_bytes(self) -> bytes:
        return recording_pb2.RecordingDigest(
            size_bytes=self.size_bytes, sha256=self.sha256
        ).SerializeToString()

    @staticmethod
    def from_bytes(payload: bytes) -> RecordingDigest:
        """Raises WireError when ``payload`` is no digest."""
        wire = _parsed(recording_pb2.RecordingDigest(), payload)
        return RecordingDigest(wire.size_bytes, wire.sha256)


def _parsed(wire: W, payload: bytes) -> W:
    try:
        wire.ParseFromString(payload)
    except DecodeError as error:
        raise WireError(f"{len(payload)} bytes are no answer about a recording: {error}") from error
    return wire
