"""A browser, a station and somebody who walks, for the tests of the console."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Locator, Page, expect

from tests.e2e.browser import PATIENCE_MS, open_browser
from tests.e2e.enlisting import enlist
from tests.e2e.stage import Stage
from tests.e2e.station_process import StationProcess
from tests.e2e.wearable import Wearable
from tests.rig.kept_screenshots import keep_screenshots

UNIT = "FF-07"
STATION_AWAY = ("ERR_CONNECTION", "ERR_EMPTY_RESPONSE")  # not there, or gone before it answered
expect.set_options(timeout=PATIENCE_MS)


@pytest.fixture(autouse=True)
def kept_screenshots(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[None]:
    yield
    keep_screenshots(tmp_path, request.path.stem, request.node.name)


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    yield from open_browser()


@pytest.fixture(scope="module")
def station(
    chromium: Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[StationProcess]:
    """Not started where there is no browser to look at it."""
    station = StationProcess(tmp_path_factory.mktemp("e2e") / "station")
    station.start()
    yield station
    station.stop()


@pytest.fixture(scope="module")
def page(chromium: Browser, station: StationProcess) -> Iterator[Page]:
    """The console, logged in through its form."""
    page = chromium.new_page(viewport={"width": 1280, "height": 800}, reduced_motion="reduce")
    log_in(page, station)
    yield page
    page.close()


def log_in(page: Page, station: StationProcess) -> None:
    page.goto(station.address)
    username, password = station.login()
    page.get_by_label("User").fill(username)
    page.get_by_label("Password").fill(password)
    page.get_by_role("button", name="Log in").click()
    page.get_by_role("region", name="People").wait_for()


@pytest.fixture
def stage(chromium: Browser) -> Iterator[Stage]:
    stage = Stage(chromium)
    yield stage
    stage.close()


@pytest.fixture(scope="module")
def wearable(station: StationProcess) -> Iterator[Wearable]:
    with Wearable(UNIT, station.bus) as wearable:
        yield wearable


@pytest.fixture(scope="module")
def complaints(page: Page) -> Iterator[list[str]]:
    """Errors in the browser: broken scripts, and refusals of the content policy.

    At the end there must be none that a test did not expect, and take out.
    """
    stated: list[str] = []

    def note(message: ConsoleMessage) -> None:
        if message.type == "error" and not any(one in message.text for one in STATION_AWAY):
            stated.append(f"{message.text} {message.location.get('url', '')}")

    page.on("console", note)
    page.on("pageerror", lambda error: stated.append(str(error)))
    yield stated
    assert stated == []


@pytest.fixture(scope="module")
def only_the_station(page: Page, station: StationProcess) -> Iterator[None]:
    """In the end the page has asked nobody else for anything."""
    asked: set[str] = set()
    page.on("request", lambda request: asked.add(urlsplit(request.url).netloc))
    yield
    assert asked == {station.http}


@pytest.fixture(scope="module")
def card(page: Page, complaints: list[str], only_the_station: None, wearable: Wearable) -> Locator:
    """Card of a responder who was added through the page while the unit was already sending."""
    card = page.locator(f"[data-unit='{UNIT}']")
    card.wait_for()
    enlist(page, card, UNIT)
    return card
