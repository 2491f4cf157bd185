"""Languages, themes, shortcuts, wall, gloves and the board with everybody on them.

The crowd is silent meanwhile: these screens show old places and lost links as well.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.console_page import barriers, close, take_picture
from tests.e2e.crowd.incident import NAMES, RESCUER, Incident
from tests.e2e.display_sizes import (
    ARC_MIN_PER_PX,
    CAPITALS_PX,
    GLOVED_PX,
    SMALLEST_ARC_MIN,
    TOO_SMALL,
)
from tests.e2e.language_checks import english_on
from tests.e2e.layout_checks import flaws

LANGUAGES = {"de": "Deutsch", "fr": "Français"}
BEYOND_PX = "shown => shown.scrollWidth - shown.clientWidth"


@pytest.fixture(scope="module", autouse=True)
def silent(incident: Incident) -> Iterator[None]:
    """Afterwards the page is as usual, also if a test has failed."""
    incident.crowd.be_silent()
    yield
    incident.page.evaluate("localStorage.clear()")
    incident.page.reload()


def display(page: Page) -> Locator:
    """The dialog, in any language."""
    page.keyboard.press("?")
    dialog = page.locator("dialog[open]")
    dialog.wait_for()
    return dialog


def leave(page: Page) -> None:
    page.keyboard.press("Escape")
    expect(page.locator("dialog")).to_have_count(0)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_text_is_in_the_language_and_none_is_cut(
    incident: Incident, tmp_path: Path, language: str
) -> None:
    page = incident.page
    display(page).get_by_role("radio", name=LANGUAGES[language]).check()
    leave(page)
    expect(page.locator("html")).to_have_attribute("lang", language)
    take_picture(page, tmp_path, f"{language}-{incident.people}.png")
    assert flaws(page) == []
    assert english_on(page, language) == set()
    for key in ("e", "a"):
        page.keyboard.press(key)
        dialog = page.locator("dialog[open]")
        dialog.wait_for()
        take_picture(page, tmp_path, f"{language}-{key}-{incident.people}.png")
        assert dialog.evaluate(BEYOND_PX) <= 0
        assert flaws(page) == []
        assert english_on(page, language) == set()
        leave(page)
    display(page).get_by_role("radio", name="English").check()
    leave(page)


@pytest.mark.parametrize("name", ["Dark", "Red light", "Light"])
def test_theme_is_accessible(incident: Incident, tmp_path: Path, name: str) -> None:
    page = incident.page
    display(page).get_by_role("radio", name=name, exact=True).check()
    leave(page)
    take_picture(page, tmp_path, f"{name.split(maxsplit=1)[0].lower()}-{incident.people}.png")
    assert flaws(page) == []
    assert barriers(page) == []


def test_shortcuts_open_dialogs_and_send_nothing(incident: Incident) -> None:
    page = incident.page
    sent: list[str] = []
    page.on("request", lambda one: sent.append(one.url) if one.method != "GET" else None)
    for key, title in (("e", "Evacuate"), ("p", "PAR"), ("a", "Alarms"), ("?", "Display")):
        page.keyboard.press(key)
        expect(page.get_by_role("dialog").get_by_role("heading", level=2)).to_have_text(title)
        leave(page)
    page.keyboard.press("n")
    expect(page.locator(".card.chosen")).to_contain_text("Mayday")
    assert sent == []


def test_wall_is_legible_from_2_m_and_counts_whom_it_has_no_room_for(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    display(page).get_by_role("checkbox", name="Names, state and floor").check()
    leave(page)
    rows = page.get_by_role("list", name="People").get_by_role("listitem")
    expect(rows.first).to_contain_text("Mayday")
    take_picture(page, tmp_path, f"wall-{incident.people}.png")
    capitals = page.evaluate(CAPITALS_PX)
    assert [one for one in capitals if one[1] * ARC_MIN_PER_PX < SMALLEST_ARC_MIN] == []
    left_out = re.search(r"(\d+)", page.locator(".wall-more").inner_text())
    assert left_out is not None
    assert rows.count() + int(left_out[1]) == incident.people
    page.get_by_role("button", name="Leave wall").click()
    expect(page.get_by_role("searchbox")).not_to_be_focused()


def test_targets_for_gloves_are_15_mm(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    display(page).get_by_role("checkbox", name="Large targets").check()
    leave(page)
    take_picture(page, tmp_path, f"gloves-{incident.people}.png")
    assert page.evaluate(TOO_SMALL, GLOVED_PX) == []
    assert flaws(page) == []
    display(page).get_by_role("checkbox", name="Large targets").uncheck()
    leave(page)


def test_board_lists_and_prints_everybody(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    page.get_by_role("button", name="Board").click()
    board = page.get_by_role("dialog", name="Board")
    expect(board.locator("tbody tr")).to_have_count(incident.people)
    page.emulate_media(media="print")
    row = board.get_by_role("row").filter(has_text=NAMES[RESCUER])
    expect(row).to_be_visible()
    expect(page.locator(".header")).to_be_hidden()
    colours = "(one) => [getComputedStyle(one).color, getComputedStyle(one).backgroundColor]"
    assert row.get_by_role("cell").first.evaluate(colours) == [
        "rgb(0, 0, 0)",
        "rgb(255, 255, 255)",
    ]
    heading = board.get_by_role("heading", name="Board").bounding_box()
    assert heading is not None
    assert heading["y"] >= 0, "the heading is on the paper"
    take_picture(page, tmp_path, f"board-{incident.people}.png")
    page.emulate_media(media="screen")
    close(board)
