"""The console in a real browser, on a real station, with a unit that speaks over the real bus.

One story in several tests: they run in the order in which they stand here.
"""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from PIL import Image
from playwright.sync_api import Browser, ConsoleMessage, Locator, Page, expect

from tests.e2e.conftest import UNIT, log_in
from tests.e2e.console_page import (
    SOON_MS,
    answer_to,
    barriers,
    click_plan,
    close,
    command,
    confirm,
    drag,
    menu,
    metres_north,
    painted,
    pins,
)
from tests.e2e.station_process import StationProcess
from tests.e2e.wearable import Wearable

INCIDENT = "Mill Road 7"
NAME = "Ana Kovač"

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
    confirm(alarm, "Resolve")
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


def test_a_pin_is_set_with_a_click_dragged_and_removed(page: Page, card: Locator) -> None:
    card.get_by_role("button", name="Pin on the plan").click()
    form = page.get_by_role("form", name=f"Pin: {NAME}")
    click_plan(page, -150, -80)
    expect(form.get_by_label("North, m")).not_to_have_value("", timeout=SOON_MS)
    form.get_by_label("Sure to within").select_option("4")
    form.get_by_role("button", name="Set pin").click()
    expect(form).to_have_count(0, timeout=SOON_MS)
    (pin,) = pins(page)
    assert (pin["unit_id"], pin["std_m"], pin["by"]) == (UNIT, 2.0, "admin")
    expect(page.get_by_text("Pins 1")).to_be_visible(timeout=SOON_MS)
    moved = drag(page, (-150, -80), (-90, -40))
    assert moved["pin_id"] == pin["pin_id"]
    right_m, down_m = moved["east_m"] - pin["east_m"], pin["north_m"] - moved["north_m"]
    assert right_m > 0.5
    assert down_m == pytest.approx(right_m * 40 / 60, rel=0.1)
    page.get_by_role("button", name="Pins 1").click()
    page.get_by_role("button", name=f"{NAME} here").click()
    expect(form.get_by_label("East, m")).to_have_value(f"{moved['east_m']:.1f}", timeout=SOON_MS)
    confirm(form, "Remove pin")
    expect(form).to_have_count(0, timeout=SOON_MS)
    assert pins(page) == []


def test_each_kind_of_trail_is_drawn_and_taken_away(page: Page, card: Locator) -> None:
    card.get_by_role("button", name=NAME).click()
    page.wait_for_timeout(600)  # the plan has come to rest
    page.get_by_role("button", name="Trails").click()
    kinds = page.get_by_role("region", name="Trails")
    kinds.get_by_label("As shown at the time").uncheck()  # it lies above the others
    for word, kind, colour in (
        ("own path", "raw", "--quiet"),
        ("Best known since", "smoothed", "--watch"),
    ):
        before = painted(page, colour)
        with page.expect_response(re.compile(rf"trails\?kind={kind}")) as said:
            kinds.get_by_label(word).check()
        (trail,) = said.value.json()["trails"]
        assert (trail["unit_id"], len(trail["points"]) > 1) == (UNIT, True)
        expect(kinds).not_to_contain_text("is worked out", timeout=SOON_MS)
        page.wait_for_timeout(300)
        assert painted(page, colour) > before + 50, kind
        kinds.get_by_label(word).uncheck()
        page.wait_for_timeout(300)
        assert painted(page, colour) < before + 50, kind
    kinds.get_by_label("As shown at the time").check()
    kinds.get_by_role("button", name="Close").click()


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


def test_the_units_are_looked_after_in_their_dialog(page: Page, card: Locator) -> None:
    dialog = menu(page, "Units")
    row = dialog.get_by_role("row", name=UNIT)
    expect(row).to_contain_text("1 min 15 s behind ± 3 ms", timeout=SOON_MS)
    row.get_by_role("button", name=f"Fetch the recording of {UNIT}").click()
    expect(row).to_contain_text("waiting", timeout=SOON_MS)
    close(dialog)
    page.get_by_role("button", name="Station health").click()
    health = page.get_by_role("dialog")
    pull = health.get_by_role("region", name="Raw recordings").get_by_role("listitem")
    expect(pull).to_contain_text(f"{UNIT}waiting")
    assert barriers(page) == []
    pull.get_by_role("button", name=f"Stop the recording of {UNIT}").click()
    expect(pull).to_contain_text("stopped by a person", timeout=SOON_MS)
    close(health)


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


def test_everybody_can_read_how_good_the_positions_were(page: Page, card: Locator) -> None:
    menu(page, "Incidents").get_by_role("button", name="How good were the positions?").click()
    dialog = page.get_by_role("dialog", name=INCIDENT)
    errors = dialog.get_by_role("table", name="ISO/IEC 18305")
    expect(errors.get_by_role("rowheader", name=f"{NAME} ({UNIT})")).to_be_visible(timeout=SOON_MS)
    everybody = errors.get_by_role("row", name="Everybody")
    expect(everybody).to_contain_text(re.compile(r"as promised then(\d+\.\d\sm){4}"))
    assert barriers(page) == []
    dialog.get_by_role("button", name="All incidents").click()
    close(page.get_by_role("dialog", name="Incidents"))


def test_a_past_incident_is_replayed(page: Page, card: Locator) -> None:
    dialog = menu(page, "Incidents")
    confirm(dialog, "Close this incident")
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


def test_a_person_is_forgotten_by_who_writes_the_name(
    page: Page, card: Locator, complaints: list[str]
) -> None:
    name = "Bo Stein"
    dialog = menu(page, "People")
    dialog.get_by_label("Name", exact=True).fill(name)
    dialog.get_by_role("button", name="Add person").click()
    row = dialog.get_by_role("row", name=name)
    row.get_by_role("button", name=f"Forget {name}").click()
    row.get_by_label(f"Write “{name}” to go on").fill("Bo")
    row.get_by_role("button", name="Forget for good").click()
    notice = page.get_by_text("The name is another")
    expect(notice).to_have_count(1, timeout=SOON_MS)
    assert "422" in complaints.pop()  # the browser notes the refusal, as it should
    row.get_by_label(f"Write “{name}” to go on").fill(name)
    row.get_by_role("button", name="Forget for good").click()
    expect(row).to_have_count(0, timeout=SOON_MS)
    expect(dialog.get_by_role("row", name=NAME)).to_be_visible()
    close(dialog)
    page.get_by_role("alert").get_by_role("button", name="OK").click()
    assert name not in str(answer_to(page, "audit?limit=1000"))


def test_the_plan_is_put_on_the_earth_with_two_clicks(page: Page, card: Locator) -> None:
    for _ in range(2):
        page.get_by_role("button", name="Zoom out").click()
    menu(page, "Site").get_by_role("button", name="By two points of the plan").click()
    form = page.get_by_role("form", name="Place on the Earth")
    click_plan(page, -150, 60)
    click_plan(page, 150, -60)
    (south_m, west_m), (north_m, east_m) = clicked_places(form)
    per_degree_m = 111_319.5  # on the equator, east
    fill_point(form, 0, 0.0, 16.0)
    fill_point(
        form, 1, 2 * (north_m - south_m) / 110_574.3, 16.0 + (east_m - west_m) / per_degree_m
    )
    form.get_by_role("button", name="Set place").click()
    expect(form.get_by_role("alert")).to_contain_text("m apart on the plan")
    fill_point(form, 1, (north_m - south_m) / 110_574.3, 16.0 + (east_m - west_m) / per_degree_m)
    form.get_by_role("button", name="Set place").click()
    expect(form).to_have_count(0, timeout=SOON_MS)
    anchor = answer_to(page, "site/anchor")
    assert anchor["lat_deg"] * 110_574.3 == pytest.approx(-south_m, abs=0.5)
    assert (anchor["lon_deg"] - 16.0) * per_degree_m == pytest.approx(-west_m, abs=0.5)
    assert anchor["plan_rotation_rad"] == pytest.approx(0.0, abs=0.01)


def test_the_plan_is_put_on_the_earth_by_a_map_given_for_it(
    page: Page, card: Locator, tmp_path: Path
) -> None:
    """Two clicks on the plan and two on the map; then the map lies behind the plan."""
    picture, world = tmp_path / "ground.png", tmp_path / "ground.pgw"
    Image.new("RGB", (400, 200), (60, 110, 60)).save(picture)
    per_degree_m = 111_319.5
    pixel = 0.5 / per_degree_m  # half a metre
    world.write_text(f"{pixel}\n0\n0\n{-pixel}\n16.0\n0.0\n")
    site = menu(page, "Site")
    site.get_by_label("Picture").set_input_files(picture)
    site.get_by_label("World file").set_input_files(world)
    site.get_by_role("button", name="Set base map").click()
    expect(site.get_by_role("button", name="Remove base map")).to_be_visible(timeout=SOON_MS)
    site.get_by_role("button", name="By two points of the plan").click()
    form = page.get_by_role("form", name="Place on the Earth")
    click_plan(page, -150, 60)
    click_plan(page, 150, -60)
    (south_m, west_m), (north_m, east_m) = clicked_places(form)
    box = form.get_by_alt_text("Base map").bounding_box()
    assert box is not None
    scale = box["width"] / 200.0  # pixels a metre on the screen
    across, down = 20.0, box["height"] - 10.0
    ground = form.get_by_alt_text("Base map")
    for to_east_m, to_north_m in ((0.0, 0.0), (east_m - west_m, north_m - south_m)):
        at = {"x": across + to_east_m * scale, "y": down - to_north_m * scale}
        ground.click(position=at)  # type: ignore[arg-type]  # of Playwright's own
    form.get_by_role("button", name="Set place").click()
    expect(form).to_have_count(0, timeout=SOON_MS)
    anchor = answer_to(page, "site/anchor")
    assert anchor["plan_rotation_rad"] == pytest.approx(0.0, abs=0.05)
    lon_m = (anchor["lon_deg"] - 16.0) * per_degree_m
    assert lon_m == pytest.approx(across / scale - west_m, abs=2.0)
    page.wait_for_function("document.querySelector('canvas.base-map')?.width > 0")
    assert barriers(page) == []
    confirm(menu(page, "Site"), "Remove base map")
    expect(page.get_by_role("button", name="Remove base map")).to_have_count(0)
    page.keyboard.press("Escape")


def clicked_places(form: Locator) -> list[tuple[float, float]]:
    """North and east, as the panel says them."""
    found = re.findall(r"(-?[\d.]+) m north, (-?[\d.]+) m east", form.text_content() or "")
    assert len(found) == 2
    return [(float(north), float(east)) for north, east in found]


def fill_point(form: Locator, index: int, lat_deg: float, lon_deg: float) -> None:
    form.get_by_label("Latitude, °").nth(index).fill(f"{lat_deg:.9f}")
    form.get_by_label("Longitude, °").nth(index).fill(f"{lon_deg:.9f}")


def test_two_machines_under_one_name_are_unmistakable(
    page: Page, card: Locator, station: StationProcess
) -> None:
    name = "FF-09"
    with Wearable(name, station.bus), Wearable(name, station.bus):
        cloned = page.locator(f"[data-unit='{name}']")
        expect(cloned).to_contain_text("Somebody may be unseen: two machines", timeout=2 * SOON_MS)
        row = menu(page, "Units").get_by_role("row", name=name)
        expect(row).to_contain_text("two machines speak under this name")
        close(page.get_by_role("dialog"))
    expect(card).not_to_contain_text("two machines")


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
