"""HTTP server that gives the tone pattern as an endless WAV, in real time; it can misbehave."""

from __future__ import annotations

import struct
import threading
import time
from enum import Enum
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType

from shared.clock import NS_PER_S
from tests.rig.tone_pattern import tone_pattern

RATE_HZ = 16_000
_ENDLESS = 0xFFFF_FFFF
_HEAD = (
    *(b"RIFF", struct.pack("<I", _ENDLESS), b"WAVEfmt "),
    *(struct.pack("<IHHIIHH", 16, 1, 1, RATE_HZ, 2 * RATE_HZ, 2, 16), b"data"),
    struct.pack("<I", _ENDLESS),
)


class Behaviour(Enum):
    PLAYS = "plays"
    HANGS = "hangs"  # the connection stays, nothing comes
    ENDS = "ends"  # connections are ended at once
    RUBBISH = "rubbish"  # what is no audio


class AudioStream:
    """As a context manager; ``behaviour`` can be changed at any time."""

    def __init__(self) -> None:
        self.behaviour = Behaviour.PLAYS
        stream = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:  # the library's name
                stream._serve(self)

            def log_message(self, format: str, *args: object) -> None:  # noqa: A002  # as above
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self._server.server_port}/radio.wav"
        self._ended = threading.Event()

    def __enter__(self) -> AudioStream:
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        self._ended.set()
        self._server.shutdown()
        self._server.server_close()

    def _serve(self, request: BaseHTTPRequestHandler) -> None:
        if self.behaviour is Behaviour.ENDS:
            return
        request.send_response(200)
        request.send_header("Content-Type", "audio/wav")
        request.end_headers()
        try:
            if self.behaviour is Behaviour.RUBBISH:
                request.wfile.write(b"<html>no radio here</html>" * 4_000)
                return
            self._play(request)
        except OSError:
            return  # whoever listened is gone

    def _play(self, request: BaseHTTPRequestHandler) -> None:
        request.wfile.write(b"".join(_HEAD))
        began_ns, given = time.time_ns(), 0
        while not self._ended.wait(0.02):
            if self.behaviour is Behaviour.HANGS:
                continue
            if self.behaviour is not Behaviour.PLAYS:
                return
            until = (time.time_ns() - began_ns) * RATE_HZ // NS_PER_S
            samples = tone_pattern(began_ns, given, until - given, RATE_HZ)
            request.wfile.write(samples.tobytes())
            request.wfile.flush()
            given = until
