"""Past incidents from an archive on S3, as an officer opens them on the page of a department."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from base_station.department_wire import IncidentEvent
from base_station.security.pki.folder import PkiFolder
from shared.enrolment import Holder
from tests.rig.archived_station import make_station, succeeded
from tests.rig.bucket_server import BUCKET, BucketServer, bucket_server
from tests.rig.department_process import DepartmentProcess
from tests.rig.department_reporter import DepartmentReporter
from tests.rig.loaded_program import launch_loaded
from tests.rig.station_process import free_port

MINUTE_MS = 60_000
STATION = "engine-7"
BEYOND_PX = "row => (row = row.closest('section'), row.scrollWidth - row.clientWidth)"
_LOGIN = re.compile(r"User (\S+), password (\S+)")
ADDRESS = f"s3://{BUCKET}/city"


class Place(NamedTuple):
    process: DepartmentProcess
    address: str
    server: BucketServer


@pytest.fixture(scope="module")
def place(chromium: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Place]:
    """A station has closed three incidents, and archived two of them."""
    folder = tmp_path_factory.mktemp("archived")
    make_station(folder / "station")
    listen, http_port = f"tls/127.0.0.1:{free_port()}", free_port()
    pki = PkiFolder(folder / "city")
    pki.create("City", hosts=[], connect=[listen])
    settings = folder / "department.toml"
    settings.write_text(
        f'[archive]\nlocation = "{ADDRESS}"\nfirst_port = {free_port()}\nreplays = 2\n'
    )
    process = DepartmentProcess(
        folder / "city", listen, http_port, launch_loaded, settings=settings
    )
    with pytest.MonkeyPatch.context() as environment, bucket_server() as server:
        for variable, value in server.environment().items():
            environment.setenv(variable, value)
        succeeded("archive", "copy", f"{ADDRESS}/{STATION}", "--data", folder / "station")
        process.start()
        reporter = DepartmentReporter(pki.enroll(STATION, Holder.DEPARTMENT_STATION))
        try:
            ended_ms = reporter.now_ms() - 60 * MINUTE_MS
            reporter.hand_over(
                *(
                    IncidentEvent(incident_id, name, ended_ms - 30 * MINUTE_MS, ended_ms)
                    for incident_id, name in (
                        ("i1", "Mill Lane"), ("i2", "Harbour"), ("i9", "Not copied yet"),
                    )
                )
            )  # fmt: skip
            yield Place(process, f"http://127.0.0.1:{http_port}", server)
        finally:
            reporter.close()
            process.kill()


@pytest.fixture
def page(chromium: Browser, place: Place) -> Iterator[Page]:
    page = chromium.new_page(viewport={"width": 1440, "height": 900}, reduced_motion="reduce")
    page.goto(place.address)
    log_in(page, *place.process.login())
    page.locator("#people").wait_for()
    yield page
    page.close()


def log_in(page: Page, username: str, password: str) -> None:
    page.locator("[name=username]").fill(username)
    page.locator("[name=password]").fill(password)
    page.locator("button.primary").click()


def incident(page: Page, name: str) -> Locator:
    return page.get_by_role("region", name="Incidents").get_by_role("row").filter(has_text=name)


def test_officer_opens_a_past_incident_from_the_bucket(
    page: Page, chromium: Browser, tmp_path: Path
) -> None:
    row = incident(page, "Mill Lane")
    row.get_by_role("button").click()
    address, username, password = opened(row)
    page.screenshot(path=tmp_path / "opened.png", full_page=True)
    replay = chromium.new_page(viewport={"width": 1440, "height": 900}, reduced_motion="reduce")
    replay.goto(address)
    log_in(replay, username, password)
    people = replay.get_by_role("region", name="People")
    expect(people).to_contain_text("Ada")
    expect(people).to_contain_text("Bo")
    expect(replay.get_by_role("banner")).to_contain_text("Mill Lane")
    replay.screenshot(path=tmp_path / "replay.png")
    replay.close()


def test_page_shows_why_a_past_incident_does_not_open(
    page: Page, place: Place, tmp_path: Path
) -> None:
    """One that was never copied; and one of a bucket that is away, which opens when it is back."""
    never = incident(page, "Not copied yet")
    never.get_by_role("button").click()
    expect(never.get_by_role("status")).to_contain_text("no complete copy of i9")
    row = incident(page, "Harbour")
    place.server.stop()
    try:
        row.get_by_role("button").click()
        expect(row.get_by_role("status")).to_contain_text(f"{ADDRESS}/{STATION}")
        page.screenshot(path=tmp_path / "away.png", full_page=True)
        assert row.evaluate(BEYOND_PX) <= 0, "the reason can be read"
    finally:
        place.server.start()
    row.get_by_role("button").click()
    opened(row)


def opened(row: Locator) -> tuple[str, str, str]:
    """Address, user and password of the replay that the page shows."""
    link = row.get_by_role("link", name="Open the replay")
    expect(link).to_be_visible()
    address, login = link.get_attribute("href"), _LOGIN.search(row.inner_text())
    assert address is not None
    assert login is not None
    return address, login[1], login[2]
