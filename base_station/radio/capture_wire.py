"""Records of a process that captures a channel, over a pipe to the station."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

import msgspec

from shared.coded_text import NO_CODE, TextCode, code_of_text, with_code

_HEAD = struct.Struct("<BqI")  # kind, monotonic time (ns), bytes that follow
PACKET, PROBLEM = 0, 1
_LENGTH_MAX = 65_536


class Captured(NamedTuple):
    """An Opus packet, or a problem (``encode_problem``)."""

    kind: int
    t_mono_ns: int
    content: bytes


class _ProblemText(msgspec.Struct, frozen=True):
    """Sentence for a person, and its code."""

    text: str
    code: TextCode = NO_CODE


def encode_problem(text: str) -> bytes:
    return msgspec.json.encode(_ProblemText(str(text), code_of_text(text)))


def decode_problem(content: bytes) -> str:
    """The sentence with its code; msgspec.DecodeError where the content is not valid."""
    problem = msgspec.json.decode(content, type=_ProblemText)
    return with_code(problem.text, problem.code)


def encoded(captured: Captured) -> bytes:
    head = _HEAD.pack(captured.kind, captured.t_mono_ns, len(captured.content))
    return head + captured.content


class CaptureDecoder:
    def __init__(self) -> None:
        self._waiting = b""

    def push(self, data: bytes) -> Iterator[Captured]:
        """Return complete packets; ValueError where the data is not valid."""
        self._waiting += data
        while len(self._waiting) >= _HEAD.size:
            kind, t_mono_ns, length = _HEAD.unpack_from(self._waiting)
            if kind not in (PACKET, PROBLEM) or length > _LENGTH_MAX:
                raise ValueError("this is not from a capture of audio")
            if len(self._waiting) < _HEAD.size + length:
                return
            content = self._waiting[_HEAD.size : _HEAD.size + length]
            self._waiting = self._waiting[_HEAD.size + length :]
            yield Captured(kind, t_mono_ns, content)
