"""Compression of messages to consoles: once for all, within the window of each console."""

from __future__ import annotations

import pytest
from websockets.extensions.permessage_deflate import (
    ClientPerMessageDeflateFactory,
    PerMessageDeflate,
)
from websockets.frames import Frame, Opcode

from base_station.api import shared_deflate
from base_station.api.shared_deflate import SharedDeflateFactory

MESSAGE = b'{"north_m": 12.345, "east_m": -3.21}' * 200


def ends(client: ClientPerMessageDeflateFactory) -> tuple[PerMessageDeflate, PerMessageDeflate]:
    """The extension at the station and at a console, after their handshake."""
    offered = client.get_request_params()
    # As in the header: every value is text, and a flag has none.
    asked = [(name, None if value is None else str(value)) for name, value in offered]
    server = SharedDeflateFactory(server_no_context_takeover=True, client_no_context_takeover=True)
    answer, station = server.process_request_params(asked, [])
    return station, client.process_response_params(answer, [])


@pytest.mark.parametrize("bits", [None, 9, 12, 15])
def test_console_decompresses_within_its_window(
    bits: int | None,
) -> None:
    station, console = ends(ClientPerMessageDeflateFactory(server_max_window_bits=bits))
    for _ in range(3):
        sent = station.encode(Frame(Opcode.TEXT, MESSAGE))
        assert len(sent.data) < len(MESSAGE) / 10
        assert console.decode(sent).data == MESSAGE


def test_many_consoles_cost_one_compression() -> None:
    shared_deflate.deflated.cache_clear()
    stations = [ends(ClientPerMessageDeflateFactory())[0] for _ in range(50)]
    frames = [one.encode(Frame(Opcode.TEXT, bytes(bytearray(MESSAGE)))) for one in stations]
    assert all(one.data is frames[0].data for one in frames)
    assert shared_deflate.deflated.cache_info().misses == 1


def test_small_message_is_not_compressed() -> None:
    station, console = ends(ClientPerMessageDeflateFactory())
    sent = station.encode(Frame(Opcode.TEXT, b"{}"))
    assert (sent.rsv1, sent.data) == (False, b"{}")
    assert console.decode(sent).data == b"{}"
