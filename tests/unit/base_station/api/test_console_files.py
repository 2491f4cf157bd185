"""The built console is served compressed, and cached by browsers as long as it is valid."""

from __future__ import annotations

import gzip
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI

from base_station.api.console_files import serve_built

BROTLI = b"as the build wrote it"
SCRIPT = "export const words = ['on', 'the', 'way'];\n" * 2_000


@pytest.fixture
def built(tmp_path: Path) -> FastAPI:
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<!doctype html><title>Muster</title>", encoding="utf-8")
    script = tmp_path / "assets" / "index-a1b2.js"
    script.write_text(SCRIPT, encoding="utf-8")
    script.with_name(f"{script.name}.gz").write_bytes(gzip.compress(SCRIPT.encode()))
    script.with_name(f"{script.name}.br").write_bytes(BROTLI)
    (tmp_path / "assets" / "rail-c3d4.js").write_text("let rail;", encoding="utf-8")
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
    assert answer.headers["vary"] == "Accept-Encoding"
    assert answer.headers["content-type"].startswith("text/javascript")
    assert "immutable" in answer.headers["cache-control"]
    assert answer.text == SCRIPT
    assert answer.num_bytes_downloaded < len(SCRIPT) / 10


async def test_smallest_file_that_the_client_takes_is_sent(built: FastAPI) -> None:
    async with client(built) as browser:
        accepts = {"Accept-Encoding": "gzip, deflate, br;q=0.9"}
        request = browser.build_request("GET", "/assets/index-a1b2.js", headers=accepts)
        answer = await browser.send(request, stream=True)
        sent = b"".join([part async for part in answer.aiter_raw()])
    assert answer.headers["content-encoding"] == "br"
    assert sent == BROTLI


async def test_file_without_compressed_ones_is_sent_as_it_is(built: FastAPI) -> None:
    async with client(built) as browser:
        answer = await browser.get("/assets/rail-c3d4.js", headers={"Accept-Encoding": "gzip"})
        missing = await browser.get("/assets/none.js", headers={"Accept-Encoding": "gzip"})
    assert "content-encoding" not in answer.headers
    assert answer.text == "let rail;"
    assert missing.status_code == 404


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
