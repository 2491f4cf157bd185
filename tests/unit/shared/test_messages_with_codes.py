"""Messages keep the codes of their texts on the wire."""

from __future__ import annotations

from shared.channels import EVENT, OPERATOR, REPLY
from shared.codec import decode, encode
from shared.coded_text import NO_CODE, code_of_text, coded
from shared.messages import CommandReply, CommandState, EventKind, Header, OperatorAction, UnitEvent
from shared.messages.muster.v1 import text_code_pb2
from shared.messages.station import NoteDispatch
from shared.messages.text_code import get_text_code, put_text_code

HEADER = Header("FF-01", 1, 2, 3, 4)
FAULT = coded("gone", "gone for {away_s:.0f} s ({by})", away_s=3.0, by="mia")


def test_event_and_reply_come_back_with_their_codes() -> None:
    event = UnitEvent.of(HEADER, EventKind.SENSOR_FAULT, FAULT)
    assert decode(EVENT, encode(event)) == event
    reply = CommandReply(
        HEADER, "c1", CommandState.REFUSED, str(FAULT), text_code=code_of_text(FAULT)
    )
    found = decode(REPLY, encode(reply))
    assert isinstance(found, CommandReply)
    assert (found, code_of_text(found.reason).code) == (reply, "gone")


def test_warnings_of_a_dispatch_come_back_with_their_codes_in_their_order() -> None:
    codes = (NO_CODE, code_of_text(FAULT))
    report = NoteDispatch("17", "json", warnings=("kaputt", str(FAULT)), warning_codes=codes)
    action = OperatorAction(HEADER, "a1", "mia", report)
    assert decode(OPERATOR, encode(action)) == action


def test_message_without_a_code_is_as_long_as_before() -> None:
    plain = UnitEvent.of(HEADER, EventKind.SENSOR_FAULT, "kaputt")
    assert plain.text_code is NO_CODE
    assert not plain.to_wire().HasField("text_code")


def test_code_is_put_and_read() -> None:
    wire = text_code_pb2.TextCode()
    assert get_text_code(wire) is NO_CODE
    put_text_code(wire, code_of_text(FAULT))
    assert get_text_code(wire) == code_of_text(FAULT)
