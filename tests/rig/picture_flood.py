"""Pictures that are put to a station: a camera's, one that is larger than it looks, and one that
hardly comes.
"""

from __future__ import annotations

import io
import socket
import urllib.error
import urllib.request
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from threading import Event, Thread
from typing import Self
from urllib.parse import urlsplit

from PIL import Image

from tests.rig.console_client import Api
from tests.rig.pacing import PATIENCE_S

_CAMERA_PX = 8660, 5774


def photograph() -> bytes:
    """Photograph of a camera: 6 MB, 50 megapixels."""
    noise = Image.effect_noise((_CAMERA_PX[0] // 8, _CAMERA_PX[1] // 8), 60.0).convert("RGB")
    return _written(noise.resize(_CAMERA_PX), "JPEG")


def bomb() -> bytes:
    """900 megapixels in a few kilobytes."""
    return _written(Image.new("1", (30_000, 30_000)), "PNG")


def put_file(api: Api, path: str, file: bytes, media_type: str = "image/jpeg") -> int:
    """The status of the answer."""
    request = urllib.request.Request(  # our own station's address
        f"{api.origin}/api/v1{path}",
        method="PUT",
        data=file,
        headers={"Content-Type": media_type, "Origin": api.origin, "Cookie": api.cookie},
    )
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
            return int(answer.status)
    except urllib.error.HTTPError as error:
        return error.code


class SlowUpload:
    """A picture that comes with so many bytes a second, in a thread of its own while entered."""

    def __init__(self, api: Api, path: str, bytes_per_s: int) -> None:
        origin = urlsplit(api.origin)
        assert origin.hostname is not None
        self._address = origin.hostname, origin.port
        self._head = (
            f"PUT /api/v1{path} HTTP/1.1\r\nHost: {origin.netloc}\r\nOrigin: {api.origin}\r\n"
            f"Cookie: {api.cookie}\r\nContent-Type: image/jpeg\r\nContent-Length: 10000000\r\n\r\n"
        )
        self._bytes_per_s = bytes_per_s
        self.answer = b""  # its first line, once it has come
        self._end = Event()
        self._thread = Thread(target=self._send, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._end.set()
        self._thread.join()

    def _send(self) -> None:
        with suppress(OSError), socket.create_connection(self._address) as connection:
            connection.sendall(self._head.encode())
            connection.settimeout(1.0)
            while not self.answer and not self._end.is_set():
                connection.sendall(bytes(self._bytes_per_s))
                with suppress(TimeoutError):
                    self.answer = connection.recv(4096).partition(b"\r\n")[0] or b"closed"


@contextmanager
def photographs_at_once(api: Api, count: int) -> Iterator[Counter[int]]:
    """Put beside what is done within; at its end how many were answered with which status."""
    picture, answered = photograph(), Counter[int]()
    people = [api.post("/people", {"name": f"P{n}"})["person_id"] for n in range(count)]
    with ThreadPoolExecutor(count) as senders:
        coming = [
            senders.submit(put_file, api, f"/people/{person_id}/photo", picture)
            for person_id in people
        ]
        yield answered
    answered.update(one.result() for one in coming)


def _written(picture: Image.Image, kind: str) -> bytes:
    written = io.BytesIO()
    picture.save(written, kind, quality=60)
    return written.getvalue()
