"""Compression of WebSocket messages (permessage-deflate, RFC 7692), done once for all consoles.

Each message is compressed by itself, without the ones before, so that the same bytes go to
everyone: fifty consoles cost the station one compression, and no memory for windows.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.extensions.permessage_deflate import (
    PerMessageDeflate,
    ServerPerMessageDeflateFactory,
)
from websockets.frames import Frame, Opcode
from websockets.typing import ExtensionParameter

_LEVEL = 6
_MIN_BYTES = 200  # smaller ones fit into one packet anyway
_KEPT = 64  # messages that some consoles have got, and others not yet
_TAIL = b"\x00\x00\xff\xff"  # of a flush; not sent (RFC 7692, 7.2.1)


class WebSocketProtocol(WebSocketsSansIOProtocol):
    """uvicorn's protocol, with this extension if the console offers it."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.conn.available_extensions = [
            SharedDeflateFactory(server_no_context_takeover=True, client_no_context_takeover=True)
        ]


class SharedDeflateFactory(ServerPerMessageDeflateFactory):
    def process_request_params(
        self, params: Sequence[ExtensionParameter], accepted_extensions: Sequence[Any]
    ) -> tuple[list[ExtensionParameter], PerMessageDeflate]:
        answer, agreed = super().process_request_params(params, accepted_extensions)
        shared = SharedDeflate(
            agreed.remote_no_context_takeover,
            agreed.local_no_context_takeover,
            agreed.remote_max_window_bits,
            agreed.local_max_window_bits,
        )
        return answer, shared


class SharedDeflate(PerMessageDeflate):
    def encode(self, frame: Frame) -> Frame:
        if frame.opcode is not Opcode.TEXT or len(frame.data) < _MIN_BYTES:
            return frame
        data = deflated(bytes(frame.data), self.local_max_window_bits)
        return Frame(frame.opcode, data, frame.fin, rsv1=True)


@lru_cache(_KEPT)
def deflated(data: bytes, window_bits: int) -> bytes:
    encoder = zlib.compressobj(_LEVEL, wbits=-window_bits)
    return (encoder.compress(data) + encoder.flush(zlib.Z_SYNC_FLUSH)).removesuffix(_TAIL)
