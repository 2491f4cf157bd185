"""Refusals of a station in the language of the console."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser, Page, expect

from tests.e2e.console_page import menu
from tests.e2e.station_process import StationProcess

PASSWORD = "correct horse battery"


def german_page(chromium: Browser, station: StationProcess) -> Page:
    page = chromium.new_page(viewport={"width": 1280, "height": 900}, locale="de-DE")
    page.goto(station.address)
    return page


def log_in(page: Page, username: str, password: str) -> None:
    page.get_by_label("Benutzer").fill(username)
    page.get_by_label("Passwort").fill(password)
    page.get_by_role("button", name="Anmelden").click()


def test_refusals_are_shown_in_the_language_of_the_browser(
    chromium: Browser, station: StationProcess, tmp_path: Path
) -> None:
    page = german_page(chromium, station)
    username, password = station.login()
    log_in(page, username, "guess")
    expect(page.get_by_role("alert").first).to_have_text("Name oder Passwort ist falsch.")
    page.screenshot(path=tmp_path / "login.png")
    log_in(page, username, password)
    page.get_by_role("region", name="Personen").wait_for()

    site = menu(page, "Einsatzstelle")
    (tmp_path / "yard.json").write_text(
        '{"type": "FeatureCollection", "features": [], "muster": {}}'
    )
    site.locator("input[type=file]").first.set_input_files(tmp_path / "yard.json")
    site.get_by_role("button", name="Plan übernehmen").click()
    broken = site.get_by_role("alert").filter(has_text="Der Plan hat keinen Maßstab")
    expect(broken).to_be_visible()
    page.screenshot(path=tmp_path / "plan.png")
    broken.get_by_role("button", name="OK").click()
    page.keyboard.press("Escape")

    menu(page, "Konto").get_by_role("button", name="Benutzer").click()
    users = page.get_by_role("dialog", name="Benutzer")
    users.get_by_label("Name", exact=True).fill(username)
    users.get_by_label("Passwort, mindestens").fill(PASSWORD)
    users.get_by_role("button", name="Benutzer hinzufügen").click()
    refused = users.get_by_role("alert").filter(has_text=f"Einen Benutzer {username} gibt es schon")
    expect(refused).to_be_visible()
    page.screenshot(path=tmp_path / "users.png")
    page.close()
