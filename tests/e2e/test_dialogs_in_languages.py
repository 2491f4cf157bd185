"""Dialogs of a running station in German and French: no English text of the catalogue is shown, and
no text is cut off.
"""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from tests.e2e.conftest import UNIT
from tests.e2e.language_checks import catalogue, english_on
from tests.e2e.station_process import StationProcess
from tests.e2e.wearable import Wearable
from tests.rig.imported_files import write_gpx

DATA = {"Officer", "station"}  # the role of a person, and who did something in the audit log
CHOICES = {  # by the key of the title of a dialog: keys of the buttons that lead to it
    "incident.title": ("menu.incidents",),
    "units.title": ("menu.units",),
    "enrolment.title": ("menu.units", "units.enrolments"),
    "people_list.title": ("menu.people",),
    "imports.title": ("menu.incidents", "imports.open_about"),
    "assessment.title": ("menu.incidents", "assessment.title"),
    "site.title": ("menu.site",),
    "display.title": ("menu.display",),
    "users.title": ("menu.account", "account.users"),
    "audit.title": ("menu.account", "audit.title"),
}
PLACE = """
() => fetch("/api/v1/site/anchor", {
  method: "PUT", headers: {"content-type": "application/json"},
  body: JSON.stringify({lat_deg: 52, lon_deg: 4}),
}).then((answer) => answer.status)
"""
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
@pytest.mark.parametrize(
    ("locale", "language", "left_out"),
    [
        ("de-DE", "de", "ein Punkt ohne Ort oder Zeit wird weggelassen"),
        ("fr-FR", "fr", "un point sans lieu ou sans heure est ignoré"),
    ],
)
def test_dialogs_have_no_english_text_and_no_cut_text(
    chromium: Browser,
    station: StationProcess,
    card: Locator,
    wearable: Wearable,
    tmp_path: Path,
    locale: str,
    language: str,
    left_out: str,
    width_px: int,
) -> None:
    expect(card).to_be_visible()
    words = {".".join(key): text for key, text in catalogue(language).items()}
    context = chromium.new_context(
        locale=locale, viewport={"width": width_px, "height": 844}, reduced_motion="reduce"
    )
    page = context.new_page()
    _log_in(page, station)
    assert page.evaluate(PLACE) < 300
    wearable.press_mayday()
    _open_menu(page, words)
    english = english_on(page, language)
    cut = []
    for title, presses in CHOICES.items():
        _open_menu(page, words)
        for key, within in zip(presses, ("#menu", "dialog"), strict=False):
            page.locator(within).get_by_role("button", name=_beginning(words[key])).first.click()
        heading = _beginning(words[title])
        page.get_by_role("dialog").get_by_role("heading", name=heading).first.wait_for()
        if title == "imports.title":
            _import_damaged_track(page, words["imports.add"], left_out, tmp_path)
        if title == "site.title":
            page.get_by_role("button", name=words["plan_form.draw"], exact=True).click()
        page.evaluate("() => document.querySelectorAll('details').forEach((one) => one.open = 1)")
        page.screenshot(path=tmp_path / f"{title}.png")
        english |= english_on(page, language)
        cut += [f"{title}: {one}" for one in page.evaluate(CUT)]
        page.keyboard.press("Escape")
        expect(page.locator("dialog")).to_have_count(0)
    page.reload()  # with the menu closed
    page.locator(f".card[data-unit='{UNIT}'] .card-head").click()
    for number in range(2):  # the timeline, and the reasons of the alarm
        page.locator(".to-records button").nth(number).click()
        page.get_by_role("dialog").wait_for()
        page.wait_for_timeout(1000)
        expect(page.get_by_role("dialog").locator(".notice")).to_have_count(0)
        page.screenshot(path=tmp_path / f"person-{number}.png")
        english |= english_on(page, language)
        cut += [f"person {number}: {one}" for one in page.evaluate(CUT)]
        page.keyboard.press("Escape")
    context.close()
    assert english <= DATA
    assert cut == []


def _beginning(message: str) -> re.Pattern[str]:
    """Matches a name by its text before the first parameter, and a whole name without one."""
    fixed, brace, _ = message.partition("{")
    spaced = re.escape(fixed).replace("\u00a0", r"\s")  # a name has ordinary spaces
    return re.compile(f"^{spaced}" + ("" if brace else "$"))


def _import_damaged_track(page: Page, add: str, left_out: str, folder: Path) -> None:
    """With a point that has no time: the list says that it is left out."""
    now_s = int(time.time())
    track = write_gpx(folder / "drone.gpx", "Drone", [(now_s, 52.0, 4.0), (now_s + 1, 52.0, 4.0)])
    content = track.read_text()
    track.write_text(content.replace("</trkseg>", '<trkpt lat="52" lon="4"/></trkseg>'))
    dialog = page.get_by_role("dialog")
    dialog.locator("input[type=file]").set_input_files(track)
    dialog.get_by_role("button", name=add, exact=True).click()
    expect(dialog.get_by_role("row").last).to_contain_text(left_out)


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
