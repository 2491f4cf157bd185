"""Problems of a station in the language of the console."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from tests.e2e.conftest import log_in
from tests.e2e.station_process import StationProcess

PLAIN_BUS = {
    "de-DE": "Der Bus ist unverschlüsseltes TCP",
    "fr-FR": "Le bus est en TCP non chiffré",
}


@pytest.mark.parametrize("locale", PLAIN_BUS)
def test_problem_of_a_running_station_is_shown_in_the_language_of_the_browser(
    chromium: Browser, station: StationProcess, tmp_path: Path, locale: str
) -> None:
    page = chromium.new_page(viewport={"width": 1280, "height": 800}, locale="en-GB")
    log_in(page, station)
    page.locator("header button.light").click()
    health = page.get_by_role("dialog")
    expect(health).to_contain_text("The bus is plain TCP")
    page.evaluate("language => localStorage.setItem('muster-language', language)", locale[:2])
    page.reload()
    page.locator("header button.light").click()
    expect(health).to_contain_text(PLAIN_BUS[locale])
    expect(health).not_to_contain_text("The bus is plain TCP")
    page.screenshot(path=tmp_path / f"problem_{locale}.png")
    page.close()
