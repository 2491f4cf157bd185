"""How the built console is served: small on the way, and kept by browsers as long as it is good."""

from __future__ import annotations

from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI

from base_station.api.console_files import serve_built

SCRIPT = "export const words = ['on', 'the', 'way'];\n" * 2_000


@pytest.fixture
def built(tmp_path: Path) -> FastAPI:
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<!doctype html><title>Muster</title>", encoding="utf-8")
    (tmp_path / "assets" / "index-a1b2.js").write_text(SCRIPT, encoding="utf-8")
    app = FastAPI()
    serve_built(app, tmp_path / "index.html")
    return app


def client(app: FastAPI) -> httpx.AsyncClient:
    return httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url="http://station.test")


async def test_the_program_is_packed_for_the_way(built: FastAPI) -> None:
    """Over a link of 64 kbit/s the console came after a minute."""
    async with client(built) as browser:
        answer = await browser.get("/assets/index-a1b2.js", headers={"Accept-Encoding": "gzip"})
    assert answer.headers["content-encoding"] == "gzip"
    assert "immutable" in answer.headers["cache-control"]
    assert answer.text == SCRIPT
    assert answer.num_bytes_downloaded < len(SCRIPT) / 10


async def test_who_cannot_unpack_it_gets_it_as_it_is(built: FastAPI) -> None:
    async with client(built) as browser:
        answer = await browser.get("/assets/index-a1b2.js", headers={"Accept-Encoding": "identity"})
    assert "content-encoding" not in answer.headers
    assert answer.text == SCRIPT
    assert answer.num_bytes_downloaded == len(SCRIPT)


async def test_the_page_itself_is_asked_for_each_time(built: FastAPI) -> None:
    async with client(built) as browser:
        answer = await browser.get("/")
    assert answer.headers["cache-control"] == "no-cache"
    assert "Muster" in answer.text
