"""The console in a real browser, on a real station, with a unit that speaks over the real bus.

One story in several tests: they run in the order in which they stand here.
"""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Locator, Page, expect

from tests.e2e.conftest import CONSOLE, UNIT, log_in
from tests.e2e.station_process import StationProcess
from tests.e2e.wearable import Wearable

AXE = CONSOLE / "node_modules/axe-core/axe.min.js"
INCIDENT = "Mill Road 7"
NAME = "Ana Kovač"
SOON_MS = 15_000

# The tests end with the station's death; a page that waits longer than this is broken.
pytestmark = pytest.mark.timeout(300)


@pytest.fixture(scope="module")
def complaints(page: Page) -> list[str]:
    """What the browser complained of: broken scripts, and what the content policy refused."""
    said: list[str] = []

    def note(message: ConsoleMessage) -> None:
        if message.type == "error" and "ERR_CONNECTION" not in message.text:
            said.append(message.text)

    page.on("console", note)
    page.on("pageerror", lambda error: said.append(str(error)))
    return said


@pytest.fixture(scope="module")
def hosts(page: Page) -> set[str]:
    """Whom the page asked for anything."""
    asked: set[str] = set()
    page.on("request", lambda request: asked.add(urlsplit(request.url).netloc))
    return asked


@pytest.fixture(scope="module")
def card(page: Page, complaints: list[str], hosts: set[str], wearable: Wearable) -> Locator:
    """Of a responder who was enlisted through the page while the unit was sending already."""
    card = page.locator(f"[data-unit='{UNIT}']")
    card.wait_for()
    register(card)
    add_person(page)
    assign(page)
    open_incident(page)
    return card


def menu(page: Page, name: str) -> Locator:
    page.get_by_role("navigation").get_by_role("button", name=name).click()
    dialog = page.get_by_role("dialog")
    dialog.wait_for()
    return dialog


def command(page: Page, name: str) -> Locator:
    page.get_by_role("group", name="Commands").get_by_role("button", name=name).click()
    dialog = page.get_by_role("dialog")
    dialog.wait_for()
    return dialog


def close(dialog: Locator) -> None:
    dialog.get_by_role("button", name="Close", exact=True).click()


def register(card: Locator) -> None:
    """In one press."""
    card.get_by_role("button", name="Register").click()
    expect(card.get_by_label(f"Who wears {UNIT}")).to_be_visible(timeout=SOON_MS)


def add_person(page: Page) -> None:
    dialog = menu(page, "People")
    dialog.get_by_label("Name", exact=True).fill(NAME)
    dialog.get_by_label("Crew").fill("Ladder 1")
    dialog.get_by_label("Role").fill("Officer")
    dialog.get_by_role("button", name="Add person").click()
    expect(dialog.get_by_role("row", name=NAME)).to_be_visible(timeout=SOON_MS)
    close(dialog)


def assign(page: Page) -> None:
    dialog = menu(page, "Units")
    dialog.get_by_label(f"Who wears {UNIT}").select_option(label=f"{NAME} (Ladder 1)")
    close(dialog)


def open_incident(page: Page) -> None:
    dialog = menu(page, "Incidents")
    dialog.get_by_label("Name of the new incident").fill(INCIDENT)
    dialog.get_by_label("Roll call every, min").first.fill("10")
    dialog.get_by_role("button", name="Open incident").click()
    expect(dialog.get_by_role("row", name=INCIDENT)).to_be_visible(timeout=SOON_MS)
    close(dialog)


def metres_north(card: Locator) -> float:
    text = card.text_content() or ""
    found = re.search(r"([\d.]+) m north", text)
    assert found is not None, text
    return float(found[1])


def test_a_wrong_password_is_refused(chromium: Browser, station: StationProcess) -> None:
    stranger = chromium.new_page()
    stranger.goto(station.address)
    stranger.get_by_label("User").fill("admin")
    stranger.get_by_label("Password").fill("guessed")
    stranger.get_by_role("button", name="Log in").click()
    expect(stranger.get_by_role("alert")).to_contain_text("wrong", timeout=SOON_MS)
    expect(stranger.get_by_role("region", name="People")).to_have_count(0)
    stranger.close()


def test_the_card_says_who_how_hot_how_sure_and_how_old(page: Page, card: Locator) -> None:
    expect(card).to_contain_text(NAME, timeout=SOON_MS)
    for words in ("Ladder 1 · Officer", "Walking", "31 °C", "83 %", "Link good", "±"):
        expect(card).to_contain_text(words, timeout=SOON_MS)
    expect(page.get_by_role("heading", name=INCIDENT)).to_be_visible()


def test_the_responder_moves_on_card_and_plan(page: Page, card: Locator) -> None:
    card.get_by_role("button", name=NAME).click()
    page.wait_for_timeout(600)  # the plan has come to rest
    plan = page.locator(".map")
    before_m, seen = metres_north(card), plan.screenshot()
    page.wait_for_timeout(2000)
    assert metres_north(card) > before_m + 1.0
    assert plan.screenshot() != seen


def test_a_mayday_is_seen_acknowledged_and_resolved(
    page: Page, card: Locator, wearable: Wearable
) -> None:
    wearable.press_mayday()
    strip = page.get_by_role("region", name="Open alarms")
    alarm = strip.get_by_role("listitem").filter(has_text=f"Mayday from {NAME}")
    expect(alarm).to_contain_text("Immediate", ignore_case=True, timeout=SOON_MS)
    expect(card).to_contain_text("Mayday")
    alarm.get_by_role("button", name="Acknowledge").click()
    expect(alarm).to_contain_text("acknowledged by admin", timeout=SOON_MS)
    wearable.cancel_mayday()
    alarm.get_by_role("button", name="Resolve").click()
    expect(alarm).to_have_count(0, timeout=SOON_MS)


def test_a_roll_call_is_received_and_acknowledged(
    page: Page, card: Locator, wearable: Wearable
) -> None:
    dialog = command(page, "PAR")
    dialog.get_by_role("button", name="Send").click()
    row = dialog.get_by_role("row", name=NAME)
    expect(row).to_contain_text("received", timeout=SOON_MS)
    close(dialog)
    expect(card).to_contain_text("PAR", timeout=SOON_MS)
    expect(card).to_contain_text("received")
    bar = page.get_by_role("group", name="Commands")
    expect(bar).to_contain_text("0 of 1 acknowledged")
    wearable.acknowledge()
    expect(bar).not_to_contain_text("acknowledged", timeout=SOON_MS)
    dialog = command(page, "PAR")
    expect(row).to_contain_text(f"acknowledged{NAME}", timeout=SOON_MS)
    close(dialog)


def test_people_are_ticked_off_at_the_roll_call(page: Page, card: Locator) -> None:
    clock = page.get_by_role("button", name="until the next check-in")
    expect(clock).to_contain_text(re.compile(r"PAR 0?\d:\d\d"))
    clock.click()
    dialog = page.get_by_role("dialog")
    row = dialog.get_by_role("listitem").filter(has_text=NAME)
    row.get_by_role("button", name=f"Heard {NAME}").click()
    expect(row).to_contain_text("by admin", timeout=SOON_MS)
    close(dialog)
    expect(card).to_contain_text(re.compile(r"PAR (10:00|09:\d\d)"), timeout=SOON_MS)


def test_what_is_rarely_done_for_a_person_is_on_the_chosen_card(page: Page, card: Locator) -> None:
    actions = card.get_by_role("group", name=f"For {NAME}")
    actions.get_by_role("button", name="To rest").click()
    expect(card).to_contain_text("Resting for", timeout=SOON_MS)
    actions.get_by_role("button", name="Back to work").click()
    expect(card).to_contain_text("Inside for", timeout=SOON_MS)
    actions.get_by_role("button", name="Locate").click()
    dialog = command(page, "Message")
    expect(dialog.get_by_role("table", name="Locate")).to_contain_text("received", timeout=SOON_MS)
    close(dialog)


def test_a_pin_is_set_with_a_click_and_removed(page: Page, card: Locator) -> None:
    card.get_by_role("button", name="Pin on the plan").click()
    form = page.get_by_role("form", name=f"Pin: {NAME}")
    plan = page.locator(".map")
    plan.click(position={"x": 200, "y": 150})
    expect(form.get_by_label("North, m")).not_to_have_value("", timeout=SOON_MS)
    form.get_by_label("Sure to within").select_option("4")
    form.get_by_role("button", name="Set pin").click()
    expect(form).to_have_count(0, timeout=SOON_MS)
    (pin,) = page.evaluate("fetch('/api/v1/pins').then((answer) => answer.json())")
    assert (pin["unit_id"], pin["std_m"], pin["by"]) == (UNIT, 2.0, "admin")
    page.get_by_text("Pins 1").click()
    page.get_by_role("button", name=f"{NAME} here").click()
    form.get_by_role("button", name="Remove pin").click()
    expect(form).to_have_count(0, timeout=SOON_MS)
    assert page.evaluate("fetch('/api/v1/pins').then((answer) => answer.json())") == []


def test_what_is_begun_on_the_plan_ends_with_escape(page: Page, card: Locator) -> None:
    page.get_by_role("button", name="All start here").click()
    form = page.get_by_role("form", name="All start here")
    expect(form).to_contain_text(NAME)
    page.keyboard.press("Escape")
    expect(form).to_have_count(0)


def test_users_are_made_and_the_audit_log_names_who_did_it(page: Page, card: Locator) -> None:
    account = menu(page, "Account")
    account.get_by_role("button", name="Users").click()
    dialog = page.get_by_role("dialog", name="Users")
    dialog.get_by_label("Name", exact=True).fill("mia")
    dialog.get_by_label("Password, at least 10 characters").fill("long enough for mia")
    dialog.get_by_role("button", name="Add user").click()
    expect(dialog.get_by_label("Role of mia")).to_have_value("viewer", timeout=SOON_MS)
    dialog.get_by_label("Role of mia").select_option("commander")
    close(dialog)
    menu(page, "Account").get_by_role("button", name="Audit log").click()
    audit = page.get_by_role("dialog", name="Audit log")
    expect(audit.get_by_role("row", name="Changed user mia: commander")).to_be_visible(
        timeout=SOON_MS
    )
    expect(audit.get_by_role("row", name="Check in")).to_be_visible()
    close(audit)


def test_an_evacuation_asks_first_and_may_be_answered_by_voice(page: Page, card: Locator) -> None:
    dialog = command(page, "Evacuate")
    expect(card).not_to_contain_text("Evacuate")
    dialog.get_by_role("button", name="Evacuate now").click()
    row = dialog.get_by_role("row", name=NAME).first
    expect(row).to_contain_text("received", timeout=SOON_MS)
    row.get_by_role("button", name="Answered by voice").click()
    expect(row).to_contain_text("acknowledgedadmin", timeout=SOON_MS)
    close(dialog)


def test_a_message_stays_on_the_card_until_it_is_answered(page: Page, card: Locator) -> None:
    dialog = command(page, "Message")
    dialog.get_by_label("To").select_option(label="Ladder 1")
    dialog.get_by_label("Message", exact=True).fill("Come to the stairs")
    dialog.get_by_role("button", name="Send").click()
    close(dialog)
    expect(card).to_contain_text("Message: Come to the stairs", timeout=SOON_MS)


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_everybody_can_use_it(page: Page, card: Locator, scheme: str) -> None:
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    assert barriers(page) == []


@pytest.mark.parametrize("name", ["Incidents", "Units", "People", "Site", "Account"])
def test_everybody_can_use_the_dialogs(page: Page, card: Locator, name: str) -> None:
    dialog = menu(page, name)
    assert barriers(page) == []
    close(dialog)


def test_everybody_can_use_the_roll_call_and_the_plan(page: Page, card: Locator) -> None:
    page.get_by_role("button", name="until the next check-in").click()
    assert barriers(page) == []
    close(page.get_by_role("dialog"))
    card.get_by_role("button", name="Pin on the plan").click()
    assert barriers(page) == []
    page.keyboard.press("Escape")


def barriers(page: Page) -> list[tuple[str, list[str]]]:
    """What keeps somebody from using what is shown, as axe-core finds it."""
    if not AXE.is_file():
        pytest.skip(f"axe-core is not installed: run npm ci in {CONSOLE}")
    page.wait_for_timeout(300)
    page.evaluate(Path(AXE).read_text(encoding="utf-8"))
    found = page.evaluate("axe.run().then((result) => result.violations)")
    return [(one["id"], [node["html"] for node in one["nodes"]]) for one in found]


def test_a_past_incident_is_replayed(page: Page, card: Locator) -> None:
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name="Close this incident").click()
    dialog.get_by_role("button", name="Yes, close this incident").click()
    expect(dialog.get_by_label("Name of the new incident")).to_be_visible(timeout=SOON_MS)
    dialog.get_by_role("button", name=f"Replay {INCIDENT}").click()
    banner = page.get_by_role("region", name="Replay")
    expect(banner).to_contain_text("This is the past", timeout=SOON_MS)
    expect(card).to_contain_text(NAME, timeout=SOON_MS)
    banner.get_by_label("Time of the incident").press("End")
    resolved = page.get_by_role("region", name="Open alarms").get_by_role("listitem")
    expect(resolved).to_have_count(0, timeout=SOON_MS)
    in_the_past_m = metres_north(card)
    banner.get_by_role("button", name="Back to live").click()
    expect(banner).to_have_count(0)
    expect(card).to_contain_text("Link good", timeout=SOON_MS)
    assert metres_north(card) > in_the_past_m


def test_nothing_came_from_elsewhere_and_nothing_broke(
    station: StationProcess, card: Locator, hosts: set[str], complaints: list[str]
) -> None:
    assert hosts == {station.http}
    assert complaints == []


def test_a_lost_station_is_unmistakable_and_comes_back(
    page: Page, card: Locator, station: StationProcess
) -> None:
    expect(page.get_by_test_id("link")).to_have_text("Connected")
    station.kill()
    banner = page.get_by_role("alert").filter(has_text="Connection to the station lost")
    expect(banner).to_contain_text("is not being updated", timeout=SOON_MS)
    expect(page.get_by_test_id("link")).to_have_text("Connection lost")
    expect(card).to_contain_text("Not updated", timeout=SOON_MS)
    station.start()
    expect(banner).to_have_count(0, timeout=60_000)
    expect(card).to_contain_text(NAME)
    expect(card).to_contain_text("Link good", timeout=SOON_MS)


def test_a_station_that_only_replays_never_looks_live(
    chromium: Browser, page: Page, station: StationProcess
) -> None:
    incidents = page.evaluate("fetch('/api/v1/incidents').then((answer) => answer.json())")
    replaying = StationProcess(station.data, replayed=incidents[0]["incident_id"])
    replaying.start()
    try:
        onlooker = chromium.new_page(viewport={"width": 1280, "height": 800})
        log_in(onlooker, replaying)
        banner = onlooker.get_by_role("region", name="Replay")
        expect(banner).to_contain_text(INCIDENT, timeout=SOON_MS)
        expect(banner.get_by_label("Time of the incident")).to_be_visible()
        expect(banner.get_by_role("button", name="Back to live")).to_have_count(0)
        expect(onlooker.get_by_role("button", name="Units")).to_have_count(0)
        onlooker.close()
    finally:
        replaying.stop()
