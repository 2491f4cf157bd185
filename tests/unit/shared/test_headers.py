"""Header of every message: sender, sequence number and time."""

from __future__ import annotations

import pytest

from shared.channels import OPERATOR, TEMPERATURE
from shared.clock import NS_PER_S, ManualClock
from shared.codec import decode, encode, header_of
from shared.errors import WireError
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, Header, OperatorAction, Temperature
from shared.messages.muster.v1 import header_pb2, station_pb2
from shared.messages.station import RegisterUnit


@pytest.mark.parametrize(("schema", "unit_id"), [(0, "FF-01"), (1, "")])
def test_header_without_unit_or_schema_is_refused(schema: int, unit_id: str) -> None:
    payload = encode(Temperature(Header(unit_id, 7, 1, 5, schema=schema), 20.0))
    assert header_of(payload) is None
    with pytest.raises(WireError, match="no header"):
        decode(TEMPERATURE, payload)


def test_readable_but_invalid_message_is_refused_with_a_reason() -> None:
    """An action of a newer program; nobody is to act on the half of it that is known."""
    header = Header(STATION_ID, 7, 1, 5)
    known = encode(OperatorAction(header, "a1", "chief", RegisterUnit("FF-01", "")))
    wire = station_pb2.OperatorAction.FromString(known)
    wire.ClearField("register_unit")
    with pytest.raises(WireError, match="makes no sense"):
        decode(OPERATOR, wire.SerializeToString())


def test_sender_is_known_when_the_rest_is_unreadable() -> None:
    payload = encode(Temperature(Header("FF-01", 7, 3, 5), 20.0))
    header = header_of(payload)
    assert header is not None
    assert (header.unit_id, header.boot_id, header.seq) == ("FF-01", 7, 3)
    assert header_of(payload[:3]) is None


@pytest.mark.parametrize("number", range(2, 16))
def test_sender_is_known_for_any_content_after_the_header(number: int) -> None:
    """No field of one kind of message is taken for that of another."""
    header = Header("FF-01", 7, 3, 5).to_wire()
    begins = header_pb2.AnyMessage(header=header).SerializeToString()
    payload = begins + bytes([number << 3 | 2, 2]) + b"\xff\xfe"
    found = header_of(payload)
    assert found is not None
    assert (found.unit_id, found.boot_id, found.seq) == ("FF-01", 7, 3)


def test_earlier_capture_keeps_its_time(clock: ManualClock, header_factory: HeaderFactory) -> None:
    clock.advance(60.0)
    then_ns = clock.monotonic_ns() - 5 * NS_PER_S
    header = header_factory.header(then_ns)
    assert header.t_mono_ns == then_ns
    assert header.t_utc_ns == clock.utc_ns() - 5 * NS_PER_S
