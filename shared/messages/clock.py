"""Answer of the station to a unit that asks for the time (see docs/clocks.md)."""

from __future__ import annotations

import msgspec
from google.protobuf.message import DecodeError

from shared.errors import WireError
from shared.messages.muster.v1 import clock_pb2


class ClockAnswer(msgspec.Struct, frozen=True):
    received_utc_ns: int  # by the station's clock
    sent_utc_ns: int

    def to_bytes(self) -> bytes:
        return clock_pb2.ClockAnswer(
            received_utc_ns=self.received_utc_ns, sent_utc_ns=self.sent_utc_ns
        ).SerializeToString()

    @staticmethod
    def from_bytes(payload: bytes) -> ClockAnswer:
        """Raises WireError when ``payload`` is no answer."""
        wire = clock_pb2.ClockAnswer()
        try:
            wire.ParseFromString(payload)
        except DecodeError as error:
            raise WireError(f"{len(payload)} bytes are no clock's answer: {error}") from error
        return ClockAnswer(wire.received_utc_ns, wire.sent_utc_ns)
