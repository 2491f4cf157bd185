"""Themes, keys, wall display and gloves at a station, with a unit whose wearer calls for help."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.e2e.console_page import barriers, choose_theme, close, menu, strip
from tests.e2e.display_sizes import (
    ARC_MIN_PER_PX,
    CAPITALS_PX,
    GLOVED_PX,
    SMALLEST_ARC_MIN,
    TOO_SMALL,
)
from tests.e2e.enlisting import NAME
from tests.e2e.station_process import StationProcess
from tests.e2e.wearable import Wearable
from tests.rig.waiting import until

FAINT = 24  # of 255: what smoothing of letters may leave of another colour


def greens_and_blues(picture: bytes) -> int:
    """Number of pixels of a picture with green or blue light."""
    points = np.asarray(Image.open(io.BytesIO(picture)).convert("RGB"))
    return int((points[..., 1:].max(axis=2) > FAINT).sum())


@pytest.fixture(scope="module")
def mayday(page: Page, card: Locator, wearable: Wearable) -> Locator:
    """The row of an alarm that is raised."""
    wearable.press_mayday()
    row = strip(page).get_by_role("listitem").filter(has_text="Mayday from")
    row.wait_for()
    return row


@pytest.mark.parametrize(
    ("theme", "name"), [("light", "Light"), ("dark", "Dark"), ("red", "Red light")]
)
def test_theme_is_kept_and_accessible(
    page: Page, mayday: Locator, tmp_path: Path, theme: str, name: str
) -> None:
    choose_theme(page, name)
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", theme)
    mayday.wait_for()
    page.locator(".map canvas").first.wait_for()
    picture = page.screenshot(path=tmp_path / f"{theme}.png")
    assert barriers(page) == []
    dialog = menu(page, "Display")
    assert barriers(page) == []
    close(dialog)
    if theme != "red":
        assert greens_and_blues(picture) > 0
        return
    assert greens_and_blues(picture) == 0
    expect(mayday).to_contain_text("Emergency", ignore_case=True)  # not by its colour


def test_shortcuts_open_dialogs_and_send_nothing(page: Page, mayday: Locator) -> None:
    sent: list[str] = []
    page.on("request", lambda one: sent.append(one.url) if one.method != "GET" else None)
    dialog = page.get_by_role("dialog")
    for key, title in (("e", "Evacuate"), ("p", "PAR"), ("?", "Display")):
        page.keyboard.press(key)
        expect(dialog.get_by_role("heading", level=2)).to_have_text(title)
        page.keyboard.press("n")  # belongs to the dialog
        page.keyboard.press("Escape")
        expect(page.locator("dialog")).to_have_count(0)  # closed, and the page knows it
    assert sent == []
    search = page.get_by_role("searchbox")
    page.keyboard.press("/")
    expect(search).to_be_focused()
    page.keyboard.type("pen")
    expect(search).to_have_value("pen")  # in a text, letters are letters
    expect(dialog).to_have_count(0)
    page.keyboard.press("Escape")
    page.keyboard.press("n")
    expect(page.locator(".card.chosen")).to_contain_text("Mayday")
    page.keyboard.press("?")
    dialog.get_by_role("checkbox", name="Use them").uncheck()
    close(dialog)
    page.keyboard.press("e")
    page.wait_for_timeout(300)
    expect(dialog).to_have_count(0)
    menu(page, "Display").get_by_role("checkbox", name="Use them").check()
    close(dialog)


def test_wall_display_is_legible_from_2_m(page: Page, mayday: Locator, tmp_path: Path) -> None:
    page.set_viewport_size({"width": 1920, "height": 1080})
    menu(page, "Display").get_by_role("checkbox", name="Names, state and floor").check()
    close(page.get_by_role("dialog"))
    row = page.get_by_role("list", name="People").get_by_role("listitem").filter(has_text=NAME)
    expect(row).to_contain_text("Mayday")
    capitals = page.evaluate(CAPITALS_PX)
    assert len(capitals) >= 5
    assert [one for one in capitals if one[1] * ARC_MIN_PER_PX < SMALLEST_ARC_MIN] == []
    assert barriers(page) == []
    page.screenshot(path=tmp_path / "wall.png")
    page.get_by_role("button", name="Leave wall").click()
    page.set_viewport_size({"width": 1280, "height": 800})
    expect(mayday).to_be_visible()


def test_targets_for_gloves_are_15_mm(page: Page, mayday: Locator, tmp_path: Path) -> None:
    box = menu(page, "Display").get_by_role("checkbox", name="Large targets")
    box.check()
    close(page.get_by_role("dialog"))
    for width, height in ((1920, 1080), (1280, 800), (1024, 768)):
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(300)
        assert page.evaluate(TOO_SMALL, GLOVED_PX) == [], width
        page.screenshot(path=tmp_path / f"gloves-{width}.png")
        expect(mayday.get_by_role("button", name="Acknowledge")).to_be_in_viewport(ratio=1)
        expect(page.get_by_role("button", name="Evacuate")).to_be_in_viewport(ratio=1)
    page.set_viewport_size({"width": 1280, "height": 800})
    page.keyboard.press("?")
    assert page.evaluate(TOO_SMALL, GLOVED_PX) == []
    box.uncheck()
    close(page.get_by_role("dialog"))


def test_emergency_sounds_as_in_the_standard_and_is_spoken_optionally(
    page: Page, card: Locator, mayday: Locator
) -> None:
    page.evaluate(
        """() => {
          window.pulses = [];
          window.spoken = [];
          const start = OscillatorNode.prototype.start;
          OscillatorNode.prototype.start = function (at) { pulses.push(at); start.call(this, at); };
          speechSynthesis.speak = (one) => spoken.push(one.text);
        }"""
    )
    until(lambda: page.evaluate("pulses.length") >= 10, "it sounds again until it is taken")
    assert page.evaluate("spoken") == []
    menu(page, "Display").get_by_role("checkbox", name="Say each emergency").check()
    close(page.get_by_role("dialog"))
    until(lambda: page.evaluate("spoken.length") >= 1, "it is spoken")
    assert "Mayday from" in page.evaluate("spoken[0]")
    mayday.get_by_role("button", name="Acknowledge").click()
    expect(mayday).to_contain_text("acknowledged by")
    sounded = page.evaluate("pulses.length")
    page.wait_for_timeout(11_000)  # longer than from one burst to the next
    assert page.evaluate("pulses.length") == sounded


def test_the_board_is_printed_black_on_white(page: Page, card: Locator, tmp_path: Path) -> None:
    """Whatever the theme, and nothing but the board."""
    page.get_by_role("button", name="Board").click()
    dialog = page.get_by_role("dialog", name="Board")
    row = dialog.get_by_role("row").filter(has_text=NAME)
    expect(row).to_contain_text("Ladder 1")
    assert barriers(page) == []
    page.emulate_media(media="print")
    expect(row).to_be_visible()
    for hidden in (page.locator(".header"), dialog.get_by_role("button", name="Close")):
        expect(hidden).to_be_hidden()
    colours = "(one) => [getComputedStyle(one).color, getComputedStyle(one).backgroundColor]"
    black_on_white = ["rgb(0, 0, 0)", "rgb(255, 255, 255)"]
    assert row.get_by_role("cell").first.evaluate(colours) == black_on_white
    assert dialog.evaluate(colours) == black_on_white
    heading = dialog.get_by_role("heading", name="Board").locator("..")
    assert heading.evaluate(colours) == black_on_white
    top = dialog.bounding_box()
    assert top is not None
    assert top["y"] < 1
    page.screenshot(path=tmp_path / "board.png")
    page.emulate_media(media="screen")
    close(dialog)


def test_reload_without_the_station_shows_that_it_is_away(
    page: Page, card: Locator, station: StationProcess
) -> None:
    page.evaluate("navigator.serviceWorker.ready.then(() => true)")
    is_kept = "caches.match('/').then((one) => one !== undefined)"
    until(lambda: page.evaluate(is_kept), "the page is kept")
    kept = page.evaluate(
        "caches.open('muster-shell').then((one) => one.keys())"
        ".then((all) => all.map(({ url }) => new URL(url).pathname))"
    )
    assert {path.split("/")[1] for path in kept} == {
        "",
        "assets",
        "icon.svg",
        "manifest.webmanifest",
    }
    station.kill()
    page.reload()
    expect(page.get_by_role("heading", name="Station away")).to_be_visible()
    expect(page.get_by_role("region", name="People")).to_have_count(0)
    assert barriers(page) == []
    station.start()
    expect(page.get_by_role("heading", name="Station away")).to_have_count(0)
    page.get_by_role("region", name="People").wait_for()
