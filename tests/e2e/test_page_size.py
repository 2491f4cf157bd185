"""Size of the page over the wire until people are shown: on a slow link everybody waits for it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser

from tests.e2e.station_process import StationProcess

MOST_BYTES = 250_000
PAGE = {"Document", "Script", "Stylesheet"}
AFTERWARDS = "/assets/deferred-"  # fetched when people are shown


@pytest.mark.parametrize(
    ("locale", "people"), [("en-GB", "People"), ("de-DE", "Personen"), ("fr-FR", "Personnel")]
)
def test_page_is_small_in_every_language(
    chromium: Browser, station: StationProcess, locale: str, people: str
) -> None:
    context = chromium.new_context(locale=locale, service_workers="block")  # it keeps the files
    page = context.new_page()
    page.goto(station.address)
    username, password = station.login()
    page.locator("input").first.fill(username)
    page.locator("input[type=password]").fill(password)
    page.keyboard.press("Enter")
    shown = page.get_by_role("region", name=people, exact=True)
    shown.wait_for()

    paths: dict[str, str] = {}
    sizes: dict[str, float] = {}

    def note_answer(event: Mapping[str, Any]) -> None:
        if event["type"] in PAGE:
            paths[event["requestId"]] = urlsplit(event["response"]["url"]).path

    def note_size(event: Mapping[str, Any]) -> None:
        if event["requestId"] in paths:
            sizes[paths[event["requestId"]]] = event["encodedDataLength"]

    devtools = context.new_cdp_session(page)
    devtools.on("Network.responseReceived", note_answer)
    devtools.on("Network.loadingFinished", note_size)
    devtools.send("Network.enable")
    devtools.send("Network.setCacheDisabled", {"cacheDisabled": True})
    with page.expect_response(lambda answer: AFTERWARDS in answer.url):
        page.reload()
    shown.wait_for()
    until_shown = {path: size for path, size in sizes.items() if AFTERWARDS not in path}
    assert len(until_shown) > 4
    assert all(until_shown.values()), "files come from the station, not from a cache"
    assert sum(until_shown.values()) < MOST_BYTES, until_shown
    context.close()
