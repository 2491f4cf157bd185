"""Dialogs of a running station in German and French: no English text of the catalogue is shown, and
no text is cut off.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from tests.e2e.language_checks import catalogue, english_on
from tests.e2e.station_process import StationProcess

DATA = {"Officer", "station"}  # the role of a person, and who did something in the audit log
CHOICES = {  # by the key of the title of a dialog: keys of the buttons that lead to it
    "incident.title": ("menu.incidents",),
    "units.title": ("menu.units",),
    "enrolment.title": ("menu.units", "units.enrolments"),
    "people_list.title": ("menu.people",),
    "site.title": ("menu.site",),
    "display.title": ("menu.display",),
    "users.title": ("menu.account", "account.users"),
    "audit.title": ("menu.account", "audit.title"),
}
CUT = """
() => [...document.querySelectorAll("dialog[open] *")].filter((one) => {
  const style = getComputedStyle(one);
  const hasText = [...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
  return hasText && one.checkVisibility() && one.tagName !== "SELECT"
    && style.overflowX !== "visible" && style.clipPath !== "inset(50%)"
    && one.scrollWidth > one.clientWidth + 1;
}).map((one) => `${one.tagName} ${one.className}: ${one.textContent}`)
"""


@pytest.mark.parametrize("width_px", [1280, 390])
@pytest.mark.parametrize(("locale", "language"), [("de-DE", "de"), ("fr-FR", "fr")])
def test_dialogs_have_no_english_text_and_no_cut_text(
    chromium: Browser,
    station: StationProcess,
    card: Locator,
    tmp_path: Path,
    locale: str,
    language: str,
    width_px: int,
) -> None:
    expect(card).to_be_visible()
    words = {".".join(key): text for key, text in catalogue(language).items()}
    context = chromium.new_context(
        locale=locale, viewport={"width": width_px, "height": 844}, reduced_motion="reduce"
    )
    page = context.new_page()
    _log_in(page, station)
    _open_menu(page, words)
    english = english_on(page, language)
    cut = []
    for title, presses in CHOICES.items():
        _open_menu(page, words)
        for key, within in zip(presses, ("#menu", "dialog"), strict=False):
            page.locator(within).get_by_role("button", name=words[key], exact=True).click()
        heading = words[title]
        page.get_by_role("dialog").get_by_role("heading", name=heading).first.wait_for()
        page.evaluate("() => document.querySelectorAll('details').forEach((one) => one.open = 1)")
        page.screenshot(path=tmp_path / f"{title}.png")
        english |= english_on(page, language)
        cut += [f"{title}: {one}" for one in page.evaluate(CUT)]
        page.keyboard.press("Escape")
        expect(page.locator("dialog")).to_have_count(0)
    context.close()
    assert english <= DATA
    assert cut == []


def _log_in(page: Page, station: StationProcess) -> None:
    page.goto(station.address)
    username, password = station.login()
    page.locator("input").first.fill(username)
    page.locator("input[type=password]").fill(password)
    page.keyboard.press("Enter")
    page.locator(".header").wait_for()


def _open_menu(page: Page, words: dict[str, str]) -> None:
    """On a small screen the menu is behind a button."""
    menu = page.get_by_role("button", name=words["menu.menu"], exact=True)
    if menu.is_visible() and menu.get_attribute("aria-expanded") == "false":
        menu.click()
