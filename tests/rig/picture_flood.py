"""Pictures that are put to a station: a camera's, and one that is larger than it looks."""

from __future__ import annotations

import io
import urllib.error
import urllib.request
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

from PIL import Image

from tests.rig.console_client import Api
from tests.rig.pacing import PATIENCE_S

_CAMERA_PX = 8660, 5774


def photograph() -> bytes:
    """Of a camera: 6 MB, 50 megapixels."""
    noise = Image.effect_noise((_CAMERA_PX[0] // 8, _CAMERA_PX[1] // 8), 60.0).convert("RGB")
    return _written(noise.resize(_CAMERA_PX), "JPEG")


def bomb() -> bytes:
    """900 megapixels in a few kilobytes."""
    return _written(Image.new("1", (30_000, 30_000)), "PNG")


def put_picture(api: Api, path: str, picture: bytes) -> int:
    """The status of the answer."""
    request = urllib.request.Request(  # our own station's address
        f"{api.origin}/api/v1{path}",
        method="PUT",
        data=picture,
        headers={"Content-Type": "image/jpeg", "Origin": api.origin, "Cookie": api.cookie},
    )
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
            return int(answer.status)
    except urllib.error.HTTPError as error:
        return error.code


@contextmanager
def photographs_at_once(api: Api, count: int) -> Iterator[Counter[int]]:
    """Put beside what is done within; at its end how many were answered with which status."""
    picture, answered = photograph(), Counter[int]()
    people = [api.post("/people", {"name": f"P{n}"})["person_id"] for n in range(count)]
    with ThreadPoolExecutor(count) as senders:
        coming = [
            senders.submit(put_picture, api, f"/people/{person_id}/photo", picture)
            for person_id in people
        ]
        yield answered
    answered.update(one.result() for one in coming)


def _written(picture: Image.Image, kind: str) -> bytes:
    written = io.BytesIO()
    picture.save(written, kind, quality=60)
    return written.getvalue()
