"""Routes to a member who is down, at a station: named, drawn and sent in two presses."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, Page, expect

from tests.e2e import scenes
from tests.e2e.conftest import log_in
from tests.e2e.console_page import barriers, painted
from tests.e2e.layout_checks import flaws
from tests.e2e.station_process import StationProcess
from tests.e2e.walker import Corner, Walker
from tests.rig.waiting import until

MEMBER, NEAR, RIC, OUTSIDE = "FF-01", "FF-02", "FF-03", "FF-04"
NAMES = {MEMBER: "Jonas Bergman", NEAR: "Tomas Novak", RIC: "Mira Okafor", OUTSIDE: "Li Na"}
CREWS = {MEMBER: "Engine 1", NEAR: "Engine 1", RIC: "RIC", OUTSIDE: "Ladder 4"}
STAIRS: tuple[Corner, ...] = (
    (8.5, 12.75, 0.0),
    (11.0, 12.75, -1.6),
    (11.0, 14.25, -1.6),
    (8.5, 14.25, -3.2),
)
WALKS: dict[str, tuple[Corner, ...]] = {
    MEMBER: ((-4.0, 12.0, 0.0), (7.0, 12.0, 0.0), *STAIRS, (7.0, 14.2, -3.2), (7.0, 20.0, -3.2)),
    NEAR: ((-4.0, 12.0, 0.0), (7.0, 12.0, 0.0), (7.0, 16.0, 0.0)),
    RIC: ((-4.0, 11.0, 0.0), (-4.0, 12.5, 0.0)),
    OUTSIDE: ((-4.0, 8.0, 0.0), (-4.0, 9.0, 0.0)),
}


@pytest.fixture(scope="module")
def walkers(station: StationProcess) -> Iterator[dict[str, Walker]]:
    """Four members at an incident in the training house, who have walked to where they stay."""
    with ExitStack() as closing, httpx.Client(base_url=f"{station.address}/api/v1") as client:
        username, password = station.login()
        client.headers["origin"] = station.address
        login = {"username": username, "password": password}
        client.post("/login", json=login).raise_for_status()
        plan = {"content-type": "application/json"}
        client.put("/site/plan", content=scenes.PLAN.read_bytes(), headers=plan).raise_for_status()
        for unit_id, walk in WALKS.items():
            client.post("/units", json={"unit_id": unit_id}).raise_for_status()
            person = {"name": NAMES[unit_id], "crew": CREWS[unit_id], "role": ""}
            made = client.post("/people", json=person).raise_for_status().json()
            worn = {"unit_id": unit_id, "person_id": made["person_id"]}
            client.post("/assignments", json=worn).raise_for_status()
            north_m, east_m, _ = walk[0]
            start = {"north_m": north_m, "east_m": east_m, "std_m": 0.3, "heading_std_rad": 0.05}
            client.put(f"/units/{unit_id}/start", json=start).raise_for_status()
        client.post("/incidents", json={"name": "Mill Road 7"}).raise_for_status()
        walkers = {
            one: closing.enter_context(Walker(one, station.bus, *walk))
            for one, walk in WALKS.items()
        }

        def is_there() -> bool:
            routes = client.get(f"/units/{MEMBER}/routes", params={"rescuer_id": RIC})
            if routes.status_code != httpx.codes.OK:
                return False
            end = routes.json()[0]["places"][-1]
            return bool(end["floor"] == 1 and end["east_m"] > 19.0)

        until(is_there, "the member upstairs")
        yield walkers


@pytest.fixture(scope="module")
def page(chromium: Browser, station: StationProcess, walkers: dict[str, Walker]) -> Iterator[Page]:
    page = chromium.new_page(viewport={"width": 1440, "height": 900}, reduced_motion="reduce")
    log_in(page, station)
    walkers[MEMBER].press_mayday()
    yield page
    page.close()


def test_a_rapid_intervention_crew_is_sent_in_two_presses(
    page: Page, walkers: dict[str, Walker], tmp_path: Path
) -> None:
    casualty = page.get_by_role("list", name="Members who are down").get_by_role("button")
    expect(casualty).to_contain_text(NAMES[MEMBER])
    page.wait_for_timeout(600)
    casualty.click()
    ways = page.get_by_role("region", name=f"Ways to {NAMES[MEMBER]}")
    expect(ways.get_by_role("listitem")).to_have_count(3)
    first = ways.get_by_role("listitem").first
    expect(first).to_contain_text(NAMES[NEAR])
    expect(first).to_contain_text("up one floor")
    expect(ways.get_by_role("listitem").nth(1)).to_contain_text(NAMES[RIC])
    assert painted(page, "--chosen") > 0, "the way is drawn"
    page.screenshot(path=tmp_path / "ways.png")
    assert flaws(page) == []
    assert barriers(page) == []
    ways.get_by_role("button", name="Send RIC (1)").click()
    until(lambda: walkers[RIC].texts, "the way at the unit of the RIC")
    assert walkers[RIC].texts[0].startswith(f"Way to {NAMES[MEMBER]}: ")
    assert "to the stairs" in walkers[RIC].texts[0]
    sent = ways.get_by_role("listitem").filter(has_text=NAMES[RIC])
    expect(sent).to_contain_text("Sent")
    page.screenshot(path=tmp_path / "sent.png")
    assert walkers[NEAR].texts == []


def test_any_rescuer_can_be_chosen_and_guidance_ended(
    page: Page, walkers: dict[str, Walker]
) -> None:
    ways = page.get_by_role("region", name=f"Ways to {NAMES[MEMBER]}")
    ways.get_by_label("Another rescuer").select_option(label=NAMES[OUTSIDE])
    drawn = ways.locator("li.drawn")
    expect(drawn).to_contain_text(NAMES[OUTSIDE])
    ways.get_by_role("button", name=f"End guidance of {NAMES[RIC]}").click()
    until(lambda: len(walkers[RIC].texts) > 1, "the end at the unit of the RIC")
    assert walkers[RIC].texts[-1] == f"Way to {NAMES[MEMBER]}: ended"
    expect(ways.get_by_role("button", name=f"Send {NAMES[RIC]}")).to_be_visible()
