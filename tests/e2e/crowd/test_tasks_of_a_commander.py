"""Tasks of a commander at a real station with 40 and with 200 people, and how many presses each
takes.  Enrolling a unit and bringing a plan in are counted in ``test_set_up.py``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

import httpx
import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from shared.bus_zenoh import UnitEndpoint
from tests.e2e import scenes
from tests.e2e.conftest import log_in
from tests.e2e.console_page import Presses, close, command, menu, press, strip, take_picture
from tests.e2e.layout_checks import flaws
from tests.e2e.station_process import StationProcess
from tests.e2e.wearable import Wearable
from tests.rig.simulated_units import BenchUnit, speaking, unit_names
from tests.rig.waiting import until

CROWDS = (40, 200)
CREW_SIZE = 5
RATE_HZ = 1.0  # of the messages of one of the crowd
DOWN, RESCUER = "FF-01", "FF-02"
NAMES = {DOWN: "Jonas Bergman", RESCUER: "Mira Okafor"}
CREWS = {DOWN: "Engine 1", RESCUER: "RIC"}
SOUGHT, SOUGHT_UNIT = "Member 031", unit_names(31)[-1]
GUARD_MS = 600  # a list takes no press of a user who meant what stood there before
START = {"north_m": -6.0, "east_m": 12.0, "std_m": 0.3, "heading_std_rad": 0.05}


class Incident(NamedTuple):
    """A real incident with a crowd, of whom one is down."""

    page: Page
    people: int
    down: Wearable
    rescuer: Wearable


def set_up(client: httpx.Client, crowd: list[str]) -> None:
    """Plan, people in crews, units that they wear, and the incident."""
    plan = {"content-type": "application/json"}
    client.put("/site/plan", content=scenes.PLAN.read_bytes(), headers=plan).raise_for_status()
    names = NAMES | {unit: f"Member {number:03}" for number, unit in enumerate(crowd, 1)}
    crews = CREWS | {unit: f"Ladder {number // CREW_SIZE + 1}" for number, unit in enumerate(crowd)}
    lines = ["Name,Crew,Role", *(f"{names[unit]},{crews[unit]}," for unit in names)]
    client.post("/people/import", content="\n".join(lines).encode()).raise_for_status()
    persons = {one["name"]: one["person_id"] for one in client.get("/people").json()}
    for unit_id, name in names.items():
        client.post("/units", json={"unit_id": unit_id}).raise_for_status()
        worn = {"unit_id": unit_id, "person_id": persons[name]}
        client.post("/assignments", json=worn).raise_for_status()
    for unit_id in NAMES:
        client.put(f"/units/{unit_id}/start", json=START).raise_for_status()
    client.post("/incidents", json={"name": "Mill Road 7"}).raise_for_status()


@pytest.fixture(scope="module", params=CROWDS)
def incident(
    request: pytest.FixtureRequest, chromium: Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Incident]:
    with ExitStack() as closing:
        station = StationProcess(tmp_path_factory.mktemp("tasks") / "station")
        station.start()
        closing.callback(station.stop)
        client = closing.enter_context(httpx.Client(base_url=f"{station.address}/api/v1"))
        username, password = station.login()
        client.headers["origin"] = station.address
        login = {"username": username, "password": password}
        client.post("/login", json=login).raise_for_status()
        crowd = unit_names(request.param - len(NAMES))
        set_up(client, crowd)
        worn = {one: closing.enter_context(Wearable(one, station.bus)) for one in NAMES}
        endpoint = UnitEndpoint((station.bus,))
        units = [BenchUnit(one, endpoint, closing) for one in crowd]
        until(lambda: all(one.is_received for one in units), "the station listens")
        for one in units:
            one.introduce()
        for member in worn.values():
            member.describe("sounder")
        closing.enter_context(speaking(units, RATE_HZ))
        page = chromium.new_page(viewport={"width": 1920, "height": 1080}, reduced_motion="reduce")
        closing.callback(page.close)
        log_in(page, station)
        worn[DOWN].press_mayday()
        yield Incident(page, request.param, worn[DOWN], worn[RESCUER])


@pytest.fixture(autouse=True)
def no_dialog(incident: Incident) -> None:
    """Close the dialog that a failed test has left open, or all that follow would fail as well."""
    while (dialog := incident.page.locator("dialog[open]")).count():
        dialog.first.press("Escape")


def answer(button: Locator) -> None:
    """Press the answer to a question, once the page takes it for no double press."""
    expect(button).to_be_visible()
    button.page.wait_for_timeout(GUARD_MS)
    button.click()


def test_member_who_is_down_is_shown_without_a_press(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    casualty = page.get_by_role("list", name="Members who are down").get_by_role("button")
    expect(casualty).to_contain_text(NAMES[DOWN])
    expect(strip(page)).to_contain_text(f"Mayday from {NAMES[DOWN]}")
    expect(page.get_by_role("button", name=re.compile("^On scene"))).to_contain_text(
        str(incident.people)
    )
    take_picture(page, tmp_path, f"down-{incident.people}.png")
    assert flaws(page) == []


def test_rescue_takes_two_presses(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    page.wait_for_timeout(GUARD_MS)
    presses = Presses(page)
    page.get_by_role("list", name="Members who are down").get_by_role("button").click()
    ways = page.get_by_role("region", name=f"Ways to {NAMES[DOWN]}")
    expect(ways.get_by_role("listitem")).to_have_count(3)
    ways.get_by_role("button", name="Send RIC (1)").click()
    assert presses.count() == 2
    until(lambda: incident.rescuer.texts, "the way at the unit of the rescuer")
    take_picture(page, tmp_path, f"rescue-{incident.people}.png")


def test_sound_locator_takes_one_press_on_the_chosen_card(incident: Incident) -> None:
    page = incident.page
    card = page.locator(f"[data-unit='{DOWN}']")
    presses = Presses(page)
    card.get_by_role("button", name="Sound locator").click()
    expect(card.get_by_role("button", name="Stop sound locator")).to_be_visible()
    assert presses.count() == 1


def test_evacuation_takes_two_presses_and_its_all_clear_two(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    presses = Presses(page)
    dialog = command(page, "Evacuate")
    dialog.get_by_role("button", name="Evacuate now").click()
    expect(dialog).to_contain_text(f"of {incident.people} acknowledged")
    assert presses.count() == 2
    take_picture(page, tmp_path, f"evacuation-{incident.people}.png")
    assert flaws(page) == []
    presses = Presses(page)
    dialog.get_by_role("button", name="All clear").click()
    answer(dialog.get_by_role("button", name="Yes, all clear"))
    expect(dialog).to_contain_text("All clear (")
    assert presses.count() == 2
    close(dialog)


def test_par_request_takes_two_presses(incident: Incident) -> None:
    page = incident.page
    presses = Presses(page)
    dialog = command(page, "PAR")
    dialog.get_by_role("button", name="Send", exact=True).click()
    expect(dialog).to_contain_text(f"of {incident.people} acknowledged")
    assert presses.count() == 2
    close(dialog)


def test_par_of_a_member_in_alarm_takes_three_presses(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    presses = Presses(page)
    page.locator(".par-clock").click()
    dialog = page.get_by_role("dialog", name="PAR status")
    row = dialog.get_by_role("listitem").filter(has_text=NAMES[DOWN])
    press(row.get_by_role("button", name="Confirm by radio"))
    expect(row.get_by_role("button", name="Yes, answered by radio")).to_be_visible()
    take_picture(page, tmp_path, f"par-{incident.people}.png")
    answer(row.get_by_role("button", name="Yes, answered by radio"))
    expect(row).to_contain_text("by radio, entered by admin")
    assert presses.count() == 3
    close(dialog)
    expect(strip(page)).to_contain_text(f"Mayday from {NAMES[DOWN]}")


def test_member_is_found_without_a_press(incident: Incident) -> None:
    page = incident.page
    presses = Presses(page)
    expect(page.get_by_role("dialog")).to_have_count(0)
    page.keyboard.press("/")
    expect(page.get_by_role("searchbox")).to_be_focused()
    page.keyboard.type(SOUGHT)
    expect(page.locator(f"[data-unit='{SOUGHT_UNIT}']")).to_be_in_viewport()
    page.keyboard.press("Escape")
    assert presses.count() == 0


def test_all_of_the_crowd_stand_in_lines_after_one_press(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    presses = Presses(page)
    page.get_by_role("button", name="One line each").click()
    expect(page.locator(".card.line").first).to_be_visible()
    assert presses.count() == 1
    take_picture(page, tmp_path, f"lines-{incident.people}.png")
    assert flaws(page) == []
    page.get_by_role("button", name="One line each").click()


def test_alarm_is_acknowledged_with_one_press(incident: Incident) -> None:
    page = incident.page
    presses = Presses(page)
    row = strip(page).get_by_role("listitem").filter(has_text=NAMES[DOWN])
    # By its key: a click just after another alarm has come is ignored, as on a busy machine.
    row.get_by_role("button", name="Acknowledge").press("Enter")
    expect(row.get_by_role("button", name="Resolve")).to_be_visible()
    assert presses.count() == 1


def test_closing_names_who_is_down(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    presses = Presses(page)
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name="Close this incident").click()
    expect(dialog).to_contain_text(f"Open alarms: {NAMES[DOWN]} (Mayday)")
    assert presses.count() == 2
    take_picture(page, tmp_path, f"closing-{incident.people}.png")
    dialog.get_by_role("button", name="No", exact=True).click()
    close(dialog)
