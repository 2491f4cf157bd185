"""While a station reads its log, its console's address says how far it is."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from base_station.config import HttpConfig
from base_station.live import recovering as module
from base_station.live.recovering import recovering
from base_station.live.surroundings import Record
from base_station.server import bind
from shared.mcap_log import SegmentInfo, SegmentState

SEGMENT = SegmentInfo(Path("1.mcap"), SegmentState.CLOSED, 1000, 5000, 5, 1)


def test_the_page_and_the_api_say_how_much_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_PAGE_AFTER_S", 0.0)
    monkeypatch.setattr(module, "_SAID_EVERY_S", 0.0)
    monkeypatch.setattr(module, "_TOLD_EVERY", 1)
    seen: list[httpx.Response] = []
    said: list[str] = []

    with bind("127.0.0.1", 0) as listening:
        address = f"http://127.0.0.1:{listening.getsockname()[1]}"

        def records() -> Iterator[Record]:
            for t_ns in (1000, 2000, 3000):
                yield t_ns, "key", b""
            seen.extend(httpx.get(address + path) for path in ("/", "/api/v1/health"))

        with recovering([SEGMENT], listening, HttpConfig(), said.append) as watched:
            assert [t_ns for t_ns, _, _ in watched(records())] == [1000, 2000, 3000]
        with pytest.raises(httpx.TransportError):
            httpx.get(address, timeout=0.3)
        assert listening.fileno() >= 0

    page, api = seen
    assert (page.status_code, api.status_code) == (503, 503)
    assert "50%" in page.text
    assert "frame-ancestors" in page.headers["content-security-policy"]
    assert api.headers["retry-after"] == "2"
    assert "50%" in api.json()["title"]
    assert said[-1] == "reading the log: 50%"


def test_a_quick_start_shows_no_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_PageServer", None)
    said: list[str] = []
    with (
        bind("127.0.0.1", 0) as listening,
        recovering([SEGMENT], listening, HttpConfig(), said.append) as watched,
    ):
        assert list(watched(iter([(1000, "key", b"")]))) == [(1000, "key", b"")]
    assert said == []
