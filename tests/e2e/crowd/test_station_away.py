"""The station is killed and started again while everybody is on the page."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import expect

from tests.e2e.console_page import take_picture
from tests.e2e.crowd.incident import Incident
from tests.rig.waiting import until


def test_page_is_grey_while_the_station_is_away_and_current_afterwards(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    page.evaluate("navigator.serviceWorker.ready.then(() => true)")
    is_kept = "caches.match('/').then((one) => one !== undefined)"
    until(lambda: page.evaluate(is_kept), "the page is kept")
    incident.station.kill()
    expect(page.locator(".link-banner")).to_be_visible()
    expect(page.locator(".console.stopped")).to_be_visible()
    take_picture(page, tmp_path, f"away-{incident.people}.png")
    page.reload()
    expect(page.get_by_role("heading", name="Station away")).to_be_visible()
    incident.station.start()
    expect(page.get_by_role("heading", name="Station away")).to_have_count(0)
    on_scene = page.get_by_role("group", name="Headcount").get_by_role("button").first
    expect(on_scene).to_contain_text(str(incident.people))
    expect(page.locator(".link-banner")).to_have_count(0)
