"""Other alarm thresholds over a past incident, in the console of a real station."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.e2e.closed_incident import logged_in_page, station_after_incident
from tests.e2e.console_page import barriers, close, menu
from tests.e2e.language_checks import english_on
from tests.e2e.station_process import StationProcess
from tests.rig.resting_person import resting_person


@pytest.fixture(scope="module")
def station(
    chromium: Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[StationProcess]:
    folder = tmp_path_factory.mktemp("rehearsed")
    with station_after_incident(folder, resting_person(30.0).records) as station:
        yield station


@pytest.fixture
def page(chromium: Browser, station: StationProcess) -> Iterator[Page]:
    with logged_in_page(chromium, station) as page:
        yield page


def test_thresholds_are_rehearsed_over_a_closed_incident(page: Page) -> None:
    incidents = menu(page, "Incidents")
    incidents.get_by_role("button", name="Other alarm thresholds: Mill Lane 4").click()
    dialog = page.get_by_role("dialog", name="Other alarm thresholds: Mill Lane 4")
    expect(dialog.get_by_role("spinbutton", name="Alarm (s)")).to_have_value("30")
    expect(dialog.get_by_role("spinbutton", name="Pre-alert (s)")).to_have_value("10")
    start = dialog.get_by_role("button", name="Rehearse")
    start.click()
    expect(dialog).to_contain_text("Change a threshold")

    dialog.get_by_role("spinbutton", name="Alarm (s)").fill("20")
    start.click()
    alarms = dialog.get_by_role("table", name="No motion", exact=True)
    cells = alarms.get_by_role("row").last.get_by_role("cell")
    expect(cells).to_have_text(["3", "41.54", "0", "1", "0", "0", "2", re.compile("10.0")])
    changes = dialog.get_by_role("table", name="Alarms that change")
    expect(changes.get_by_role("rowheader", name="Anna Vos (FF-01)")).to_have_count(3)
    expect(changes).to_contain_text("not raised")
    assert barriers(page) == []

    dialog.get_by_label("Try several values of").select_option("Alarm (s)")
    dialog.get_by_role("spinbutton", name="Alarm (s)").fill("5")
    dialog.get_by_role("spinbutton", name="up to").fill("65")
    dialog.get_by_role("spinbutton", name="in steps of").fill("20")
    start.click()
    expect(dialog).to_contain_text("Left out, as it contradicts another threshold: 5.")
    expect(alarms.get_by_role("rowheader")).to_have_text(["as it was", "25", "45", "65"])
    trade_off = alarms.get_by_role("img", name=re.compile("Alarms per hour of wear by Alarm"))
    expect(trade_off).to_be_visible()
    assert barriers(page) == []
    dialog.get_by_role("button", name="All incidents").click()
    close(incidents)


@pytest.mark.parametrize("width_px", [390, 1280])
@pytest.mark.parametrize(("locale", "language"), [("de-DE", "de"), ("fr-FR", "fr")])
def test_the_dialog_fits_and_has_no_english_text(
    chromium: Browser, station: StationProcess, locale: str, language: str, width_px: int
) -> None:
    page = chromium.new_page(
        viewport={"width": width_px, "height": 844}, reduced_motion="reduce", locale=locale
    )
    username, password = station.login()
    page.goto(station.address)
    page.locator("input").first.fill(username)
    page.locator("input[type=password]").fill(password)
    page.keyboard.press("Enter")
    page.locator(".header").wait_for()
    if (button := page.locator(".menu-button")).is_visible():
        button.click()
    page.locator("#menu button").first.click()
    named = {"de": "Schwellen ändern", "fr": "Autres seuils"}[language]
    page.get_by_role("dialog").get_by_role("button", name=re.compile(named)).first.click()
    page.locator("input[name=alarm_s]").fill("20")
    page.locator(".rehearsal button").click()
    expect(page.locator("dialog table")).to_have_count(3)
    assert english_on(page, language) == set()
    wide = page.evaluate(
        "() => { const one = document.querySelector('dialog[open]');"
        " return one.scrollWidth - one.clientWidth; }"
    )
    assert wide <= 0
    page.close()
