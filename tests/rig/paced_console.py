"""Consoles without a screen that count what comes over the network, compressed or not."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import ExitStack
from threading import Thread

from websockets.exceptions import ConnectionClosed
from websockets.extensions.base import Extension
from websockets.extensions.permessage_deflate import (
    ClientPerMessageDeflateFactory,
    PerMessageDeflate,
)
from websockets.frames import Frame
from websockets.sync.client import connect
from websockets.typing import ExtensionParameter

from tests.rig.console_client import Api


class PacedConsole:
    """Takes ``FieldDelta``, confirms each at once, and counts the payload of frames as sent."""

    def __init__(self, api: Api, closing: ExitStack, *, fields: bool, compressed: bool) -> None:
        self.messages = 0
        self._fields = fields
        self._counter = _CountingFactory()
        self._raw_bytes = 0
        self._compressed = compressed
        self._socket = closing.enter_context(
            connect(
                api.live_url + ("?deltas=fields" if fields else ""),
                additional_headers={"Cookie": api.cookie, "Origin": api.origin},
                max_size=None,
                compression=None,
                extensions=[self._counter] if compressed else None,
            )
        )
        self._thread = Thread(target=self._listen, name="bench-paced-console", daemon=True)
        self._thread.start()

    @property
    def bytes_received(self) -> int:
        return self._counter.bytes_received if self._compressed else self._raw_bytes

    def close(self) -> None:
        self._socket.close()
        self._thread.join()

    def _listen(self) -> None:
        try:
            for text in self._socket:
                self.messages += 1
                if not self._compressed:
                    self._raw_bytes += len(text)
                if self._fields:
                    self._socket.send(json.dumps({"type": "shown", "count": self.messages}))
        except ConnectionClosed:
            return


class _CountingFactory(ClientPerMessageDeflateFactory):
    bytes_received = 0

    def process_response_params(
        self, params: Sequence[ExtensionParameter], accepted_extensions: Sequence[Extension]
    ) -> PerMessageDeflate:
        extension = super().process_response_params(params, accepted_extensions)
        decode = extension.decode

        def counted(frame: Frame, *, max_size: int | None = None) -> Frame:
            self.bytes_received += len(frame.data)
            return decode(frame, max_size=max_size)

        extension.decode = counted  # type: ignore[method-assign]  # looked at on its way
        return extension
