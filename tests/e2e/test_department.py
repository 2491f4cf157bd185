"""The page of a department, as an officer uses it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from playwright.sync_api import Browser, Page, expect

from base_station.department_wire import (
    AlarmEvent,
    IncidentEvent,
    IncidentSummary,
    PersonEvent,
    PersonSummary,
    PlaceSummary,
    Summary,
)
from base_station.security.pki.folder import PkiFolder
from shared.enrolment import Holder
from tests.e2e.console_page import barriers
from tests.e2e.language_checks import english_on
from tests.rig.department_process import DepartmentProcess
from tests.rig.department_reporter import DepartmentReporter
from tests.rig.loaded_program import launch_loaded
from tests.rig.station_process import free_port
from tests.rig.waiting import until

MINUTE_MS = 60_000
STATIONS = {"engine-7": (52.52, 13.40), "ladder-2": (52.50, 13.45)}
BEYOND_PX = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
PEOPLE = {"FF-01": "Anna Berg", "FF-02": "Björn Öst"}


class Place(NamedTuple):
    process: DepartmentProcess
    address: str
    reporters: dict[str, DepartmentReporter]


@pytest.fixture(scope="module")
def place(chromium: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Place]:
    """Two stations report once; a third one is enrolled and never does."""
    folder = tmp_path_factory.mktemp("department")
    listen, http_port = f"tls/127.0.0.1:{free_port()}", free_port()
    pki = PkiFolder(folder / "city")
    pki.create("City", hosts=[], connect=[listen])
    process = DepartmentProcess(folder / "city", listen, http_port, launch_loaded)
    process.start()
    reporters = {}
    for name in STATIONS:
        reporters[name] = DepartmentReporter(pki.enroll(name, Holder.DEPARTMENT_STATION))
    pki.enroll("away-3", Holder.DEPARTMENT_STATION)
    try:
        for name, reporter in reporters.items():
            report(name, reporter)
        yield Place(process, f"http://127.0.0.1:{http_port}", reporters)
    finally:
        for reporter in reporters.values():
            reporter.close()
        process.kill()


def report(name: str, reporter: DepartmentReporter) -> None:
    now_ms = reporter.now_ms()
    is_first = name == "engine-7"
    reporter.hand_over(
        IncidentEvent("i1", f"Fire at {name}", now_ms - 10 * MINUTE_MS, None),
        IncidentEvent("i0", f"Cellar of {name}", now_ms - 90 * MINUTE_MS, now_ms - 60 * MINUTE_MS),
        *(PersonEvent(f"p-{unit}", person, "A", "") for unit, person in PEOPLE.items()),
    )
    if is_first:
        reporter.hand_over(
            AlarmEvent(
                *("mayday|FF-02|1", "mayday", "FF-02", 1, "raised", "", "Mayday", ""),
                raised_ms=now_ms - MINUTE_MS,
                changed_ms=now_ms - MINUTE_MS,
            )
        )
    lat_deg, lon_deg = STATIONS[name]
    own_ms = now_ms - (0 if is_first else 3 * 60 * MINUTE_MS)  # the other one's clock is behind
    where = PlaceSummary(own_ms, 3.0, -2.0, 1, lat_deg, lon_deg, 2.5, "good")
    people = tuple(
        PersonSummary(
            *(unit, unit, f"p-{unit}", "live", "i1", where, "walking"),
            mayday=is_first and unit == "FF-02",
            alarms=("mayday|FF-02|1",) if is_first and unit == "FF-02" else (),
            par="radio",
            par_due_ms=own_ms + 10 * MINUTE_MS,
        )
        for unit in PEOPLE
    )
    reporter.publish(
        Summary(
            epoch=1,
            t_ms=own_ms,
            host=name,
            console_url=f"https://{name}.example:8080",
            incidents=(IncidentSummary("i1", f"Fire at {name}", now_ms - 10 * MINUTE_MS),),
            people=people,
            problems=(),
            waiting=0,
            lat_deg=lat_deg,
            lon_deg=lon_deg,
        )
    )


def open_page(chromium: Browser, place: Place, locale: str) -> Page:
    until(lambda: place.process.get("/department")["people"] == 4, "both summaries are there")
    page = chromium.new_page(
        viewport={"width": 1440, "height": 900}, locale=locale, reduced_motion="reduce"
    )
    page.goto(place.address)
    username, password = place.process.login()
    page.locator("[name=username]").fill(username)
    page.locator("[name=password]").fill(password)
    page.locator("button.primary").click()
    page.locator("#people").wait_for()
    return page


def test_an_officer_sees_all_stations_and_finds_people(
    chromium: Browser, place: Place, tmp_path: Path
) -> None:
    page = open_page(chromium, place, "en-GB")
    page.screenshot(path=tmp_path / "department.png", full_page=True)
    alarms = page.get_by_role("region", name="Alarms (1)")
    expect(alarms).to_contain_text("Björn Öst")
    expect(alarms.get_by_role("link", name="engine-7")).to_have_attribute(
        "href", "https://engine-7.example:8080"
    )
    incidents = page.get_by_role("region", name="Incidents")
    expect(incidents.get_by_role("row")).to_have_count(5)
    expect(incidents.get_by_role("link", name="Live view").first).to_be_visible()
    stations = page.get_by_role("region", name="Stations", exact=True)
    expect(stations).to_contain_text("has never reported")
    expect(stations).to_contain_text("behind")
    people = page.get_by_role("region", name="People")
    first = people.get_by_role("row").nth(1)
    expect(first).to_contain_text("Björn Öst")  # who needs help first
    people.get_by_role("searchbox").fill("anna")
    expect(people.get_by_role("row")).to_have_count(3)
    expect(people).not_to_contain_text("Björn")
    page.get_by_role("button", name="ladder-2:").click()
    expect(people.get_by_role("row")).to_have_count(2)
    expect(people).to_contain_text("ladder-2")
    incidents.get_by_role("searchbox").fill("ENGINE cellar")
    expect(incidents.get_by_role("row")).to_have_count(2)
    expect(incidents).to_contain_text("1 to 1 of 1")
    incidents.get_by_role("searchbox").fill("")
    expect(incidents.get_by_role("row")).to_have_count(5)
    page.get_by_role("button", name="Log out").click()
    expect(page.locator("[name=username]")).to_be_visible()
    page.close()


@pytest.mark.parametrize("locale", ["en-GB", "de-DE", "fr-FR"])
def test_page_is_complete_in_each_language_and_accessible(
    chromium: Browser, place: Place, tmp_path: Path, locale: str
) -> None:
    page, language = open_page(chromium, place, locale), locale[:2]
    expect(page.locator("html")).to_have_attribute("lang", language)
    for width in (1440, 800):
        page.set_viewport_size({"width": width, "height": 900})
        page.screenshot(path=tmp_path / f"{language}-{width}.png", full_page=True)
        assert page.evaluate(BEYOND_PX) <= 0
    assert barriers(page) == []
    if language != "en":
        assert english_on(page, language) <= {"Mayday"}
    page.close()
