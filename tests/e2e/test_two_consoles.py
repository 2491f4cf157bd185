"""The console when its station dies: it changes to the other one, and the same users continue
there.
"""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from playwright.sync_api import Browser, Page, expect

from tests.bench.standby.station_of_pair import Place, Station
from tests.bench.standby.two_stations import TwoStations
from tests.rig.loaded_program import launch_loaded

PATIENCE_MS = 60_000
COPIED_MS = 3_000  # by then the other station knows the ticket


def log_in(page: Page, station: Station) -> None:
    username, password = station.login()
    page.get_by_label("User").fill(username)
    page.get_by_label("Password").fill(password)
    page.get_by_role("button", name="Log in").click()


def test_console_follows_to_the_station_that_took_over(chromium: Browser, tmp_path: Path) -> None:
    with ExitStack() as closing:
        two = TwoStations(tmp_path, (Place(), Place()), closing, launch_loaded)
        two.start()
        two.first.post("/incidents", {"name": "Mill Lane"})
        page = chromium.new_page()
        closing.callback(page.close)
        page.goto(two.first.url)
        with page.expect_response("**/hand-over"):
            log_in(page, two.first)
        expect(page.get_by_text("Mill Lane").first).to_be_visible()
        page.wait_for_timeout(COPIED_MS)
        # Stations are hosts, which do not get each other's cookies; here they are ports of one.
        page.context.clear_cookies()
        two.first.kill()
        expect(page.get_by_role("alert")).to_contain_text("Connection to the station lost")
        page.wait_for_url(f"{two.second.url}/**", timeout=PATIENCE_MS)
        expect(page.get_by_text("Mill Lane").first).to_be_visible()
        assert "ticket" not in page.url
        silent = page.get_by_role("alert").filter(has_text="no alarm is heard here before")
        expect(silent).to_contain_text("You come from the console of")
        silent.get_by_role("button", name="OK").click()
        expect(page.get_by_role("button", name="Sound on")).to_be_visible()
        page.context.clear_cookies()  # who comes without a ticket logs in
        page.goto("about:blank")
        page.goto(f"{two.second.url}/#from=first&ticket=used")
        expect(
            page.get_by_role("status").filter(has_text="The same user and password hold here")
        ).to_be_visible()
        log_in(page, two.second)
        expect(page.get_by_text("Mill Lane").first).to_be_visible()
