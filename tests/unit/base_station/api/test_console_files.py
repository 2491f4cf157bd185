"""The built console is served compressed, and cached by browsers as long as it is valid."""

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


async def test_program_is_compressed(built: FastAPI) -> None:
    """Over a link of 64 kbit/s the uncompressed console took a minute."""
    async with client(built) as browser:
        answer = await browser.get("/assets/index-a1b2.js", headers={"Accept-Encoding": "gzip"})
    assert answer.headers["content-encoding"] == "gzip"
    assert "immutable" in answer.headers["cache-control"]
    assert answer.text == SCRIPT
    assert answer.num_bytes_downloaded < len(SCRIPT) / 10


async def test_client_without_decompression_gets_plain_files(built: FastAPI) -> None:
    async with client(built) as browser:
        answer = await browser.get("/assets/index-a1b2.js", headers={"Accept-Encoding": "identity"})
    assert "content-encoding" not in answer.headers
    assert answer.text == SCRIPT
    assert answer.num_bytes_downloaded == len(SCRIPT)


async def test_page_itself_is_revalidated_each_time(built: FastAPI) -> None:
    async with client(built) as browser:
        answer = await browser.get("/")
    assert answer.headers["cache-control"] == "no-cache"
    assert "Muster" in answer.text
