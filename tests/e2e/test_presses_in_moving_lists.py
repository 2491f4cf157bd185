"""Lists whose rows move while somebody presses in them: what one press meant hits no other."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta
from urllib.parse import quote

import msgspec
import pytest
from playwright.sync_api import Locator, Page, Route, expect

from base_station.views.wire import UnitView
from tests.e2e import scenes
from tests.e2e.console_page import close, menu
from tests.e2e.stage import ANSWERS, Stage


def stop_time(page: Page) -> None:
    """No haste is as slow as a test."""
    page.clock.pause_at(datetime.now(UTC) + timedelta(seconds=1))


def let_time_go_on(page: Page) -> None:
    """Past all haste: half a second since the answer, which may be late on a busy machine."""
    page.clock.resume()
    page.wait_for_timeout(1_200)


def press_twice(page: Page, button: Locator, between: object) -> None:
    """At one place, whatever has come there by then; what the first one sends is answered."""
    button.scroll_into_view_if_needed()
    box = button.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    assert callable(between)
    with page.expect_response(lambda answer: answer.request.method == "POST"):
        page.mouse.click(x, y)
        between()
        page.mouse.click(x, y)


def received(one: UnitView) -> UnitView:
    """The same person once somebody has heard from them."""
    assert one.duty is not None
    due_ms = scenes.NOW_MS + 20 * scenes.MINUTE_MS
    return msgspec.structs.replace(one, duty=msgspec.structs.replace(one.duty, due_ms=due_ms))


def test_double_press_confirms_one_member(stage: Stage) -> None:
    """A confirmed member moves down the list, and the next one moves to that place."""
    first, second, third = (scenes.person(index).name for index in (0, 10, 5))
    crew = [scenes.unit(index) for index in (0, 5, 10)]
    page, station = stage.open(scenes.picture(crew))
    page.locator(".par-clock").click()
    names = page.locator(".roll-crew strong")
    expect(names).to_have_text([first, second, third])
    stop_time(page)

    def received_of() -> None:
        station.change(units=(received(crew[0]),))
        expect(names).to_have_text([second, third, first])

    press_twice(
        page,
        page.get_by_role("dialog").get_by_text("Confirm by radio", exact=True).first,
        received_of,
    )
    station.expect_changes("/check-ins")
    let_time_go_on(page)
    with page.expect_response(re.compile("/check-ins$")):
        page.get_by_role("button", name=f"Confirm by radio: {second}").click()
    station.expect_changes("/check-ins", "/check-ins")


@pytest.mark.parametrize(
    ("order", "sends"), [("Evacuate", "Evacuate now"), ("PAR", "Send"), ("Message", "Send")]
)
def test_double_press_sends_one_order(stage: Stage, order: str, sends: str) -> None:
    """Everybody would have to answer twice."""
    page, station = stage.open(scenes.quiet())
    commands = page.get_by_role("group", name="Commands")
    commands.get_by_role("button", name=order, exact=True).click()
    dialog = page.get_by_role("dialog")
    if order == "Message":
        dialog.get_by_label("Message", exact=True).fill("Come out")
    stop_time(page)
    button = dialog.get_by_role("button", name=sends)
    press_twice(page, button, lambda: None)
    station.expect_changes("/commands")
    let_time_go_on(page)
    with page.expect_response(re.compile("/commands$")):  # it is on its way when it is pressed
        button.click()
    station.expect_changes("/commands", "/commands")


@pytest.mark.parametrize("order", ["Message", "Evacuate"])
def test_next_order_keeps_its_target(stage: Stage, order: str) -> None:
    """A repeated order for lack of an answer must not go to everyone."""
    sent = {"POST /commands": {"command_id": "c9"}}
    page, _ = stage.open(scenes.quiet(), answers={**ANSWERS, **sent})
    page.get_by_role("group", name="Commands").get_by_role("button", name=order).click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("combobox").select_option("crew:Engine 1")
    button = dialog.get_by_role("button", name=re.compile("Send|Evacuate now"))
    for words in ("Come out", "By the north stairs"):
        if order == "Message":
            text = dialog.get_by_label("Message", exact=True)
            expect(text).to_have_value("")
            text.fill(words)
        page.wait_for_timeout(600)  # no haste
        with page.expect_request(re.compile("/commands$")) as asked:
            button.click()
        assert (asked.value.post_data_json or {})["target"] == {"crew": "Engine 1"}


def test_order_to_a_removed_crew_is_not_sent_to_everyone(stage: Stage) -> None:
    quiet = scenes.quiet()
    page, station = stage.open(quiet)
    page.get_by_role("group", name="Commands").get_by_role("button", name="Evacuate").click()
    dialog = page.get_by_role("dialog")
    to = dialog.get_by_role("combobox")
    to.select_option("crew:Engine 1")
    station.change(units=(msgspec.structs.replace(quiet.units[0], person=None),))
    expect(page.locator(".card", has_text="unassigned")).to_have_count(1)
    expect(to).to_have_value("crew:Engine 1")
    with page.expect_request(re.compile("/commands$")) as asked:
        dialog.get_by_role("button", name="Evacuate now").click()
    assert (asked.value.post_data_json or {})["target"] == {"crew": "Engine 1"}


def test_met_unit_stays_chosen_after_its_unassignment(stage: Stage) -> None:
    quiet = scenes.quiet()
    page, station = stage.open(quiet)
    page.locator("[data-unit='FF-01']").get_by_role("button").first.click()
    page.get_by_role("button", name="Same place as …").click()
    panel = page.get_by_role("form", name="Same place")
    panel.get_by_label("With").select_option("FF-03")
    station.change(units=(msgspec.structs.replace(quiet.units[2], person=None),))
    expect(page.locator(".card", has_text="unassigned")).to_have_count(1)
    with page.expect_request(re.compile("/pins/meeting$")) as asked:
        panel.get_by_role("button", name="Save").click()
    assert (asked.value.post_data_json or {})["other_unit_id"] == "FF-03"


def test_double_press_sets_one_pin_and_adds_one_person(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    people = menu(page, "People")
    people.get_by_label("Name", exact=True).fill("Bo Stein")
    stop_time(page)
    press_twice(page, people.get_by_role("button", name="Add person"), lambda: None)
    station.expect_changes("/people")
    page.clock.resume()
    close(people)
    page.locator(".card").first.get_by_role("button").first.click()
    page.get_by_role("button", name="Correct position …").click()
    panel = page.get_by_role("form", name="Pin: ")
    panel.get_by_label("North, m").fill("1")
    panel.get_by_label("East, m").fill("2")
    stop_time(page)
    press_twice(page, panel.get_by_role("button", name="Set pin"), lambda: None)
    station.expect_changes("/people", "/pins")


def test_double_press_acknowledges_the_alarms_of_one_member(stage: Stage) -> None:
    """The acknowledged row disappears; the next member's alarm must not be acknowledged unseen."""
    page, station = stage.open(scenes.bad_minute())
    fall, still, heat, _ = scenes.bad_minute().alarms
    rows = page.get_by_role("region", name="Open alarms").get_by_role("listitem")
    expect(rows.first).to_contain_text(fall.text)
    stop_time(page)

    def taken() -> None:
        over = msgspec.structs.replace(fall, state="resolved")
        station.change(alarms=(over, msgspec.structs.replace(still, state="resolved")))
        expect(rows.first).to_contain_text(heat.text)

    press_twice(page, rows.first.get_by_role("button", name="Acknowledge"), taken)
    first = [f"/alarms/{quote(one.alarm_id)}/acknowledge" for one in (fall, still)]
    station.expect_changes(*first)
    rows.first.get_by_role("button", name="Acknowledge").press("Enter")
    station.expect_changes(*first, f"/alarms/{quote(heat.alarm_id)}/acknowledge")


def test_focus_stays_at_the_alarm_acknowledged_by_keyboard(stage: Stage) -> None:
    """The button is gone; without the focus the way begins at the top of the page again."""
    page, station = stage.open(scenes.bad_minute())
    fall = scenes.bad_minute().alarms[0]
    page.get_by_role("button", name=f"Acknowledge: {fall.text}").press("Enter")
    station.change(alarms=tuple(map(scenes.taken, scenes.bad_minute().alarms[:2])))
    expect(page.get_by_role("button", name=f"Resolve: {fall.text}")).to_be_focused()


def test_confirmation_of_everyone_is_sent_once(stage: Stage) -> None:
    """A question that was answered does not stand there for the next press."""
    page, station = stage.open(scenes.quiet())
    page.locator(".par-clock").click()
    everybody = page.get_by_role("dialog").get_by_role("button", name="Confirm all", exact=True)
    stop_time(page)
    everybody.click()
    let_time_go_on(page)
    page.get_by_role("button", name="Yes, answered by radio").click()
    expect(everybody).to_be_visible()
    station.expect_changes("/check-ins")


def test_options_of_an_assignment_are_listed_on_demand(stage: Stage) -> None:
    """Each unit with each person would be a quarter of a million entries of 500."""
    page, _ = stage.open(scenes.quiet())
    worn = menu(page, "Units").get_by_role("combobox", name="Assign ")
    expect(worn.first).to_have_value("p0")
    assert worn.locator("option").count() <= 2 * worn.count()  # nobody, and who wears it
    worn.first.hover()
    expect(worn.first.locator("option[value=p3]")).to_be_attached()


def test_arrow_keys_alone_assign_no_unit(stage: Stage) -> None:
    """Nor is that person taken from another; by keys it counts with Enter, or on leaving."""
    quiet = scenes.quiet()
    page, station = stage.open(quiet)
    worn = menu(page, "Units").get_by_label("Assign FF-01 to")
    expect(worn).to_have_value("p0")  # the people are there
    worn.focus()
    worn.press("ArrowDown")
    worn.press("ArrowDown")
    station.change(units=(received(quiet.units[0]),))
    expect(worn).to_have_value("p2")
    worn.press("ArrowUp")
    worn.press("ArrowUp")
    expect(worn).to_have_value("p0")
    worn.press("Tab")
    worn.press("ArrowDown")
    station.expect_changes()
    with page.expect_request(re.compile("/assignments$")) as asked:
        worn.press("Enter")
    assert asked.value.post_data_json == {"unit_id": "FF-01", "person_id": "p1"}
    with page.expect_request(re.compile("/assignments$")) as asked:
        worn.select_option("p3")
        worn.press("Tab")
    assert asked.value.post_data_json == {"unit_id": "FF-01", "person_id": "p3"}


def test_focus_moves_into_the_opened_panel_and_back(stage: Stage) -> None:
    """The panel stands behind forty cards; back at the top everything begins again."""
    page, _ = stage.open(scenes.crowd())
    page.locator(".card").first.get_by_role("button").first.press("Enter")
    pin = page.get_by_role("button", name="Correct position …")
    pin.press("Enter")
    page.keyboard.press("Tab")
    north = page.get_by_role("form", name="Pin: ").get_by_label("North, m")
    expect(north).to_be_focused()
    page.keyboard.press("Escape")
    expect(north).to_have_count(0)
    expect(pin).to_be_focused()
    pins = page.get_by_role("group", name="On the plan").get_by_role("button", name="Pins 2")
    pins.press("Enter")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    expect(north).to_be_focused()
    page.keyboard.press("Escape")
    expect(pins).to_be_focused()


def test_loaded_list_moves_no_control(stage: Stage) -> None:
    """A dialog grows downwards; where it grew to both sides, the press was lost."""
    dispatched = msgspec.structs.replace(scenes.quiet(), dispatches=(scenes.dispatch("2026/7"),))
    page, _ = stage.open(dispatched)
    asked: list[Route] = []

    def keep_waiting(route: Route) -> None:
        asked.append(route)

    page.route("**/api/v1/incidents?*", keep_waiting)
    dialog = menu(page, "Incidents")
    look = dialog.get_by_role("button", name="Look at dispatch 2026/7")
    expect(dialog.get_by_text("Asking the station")).to_be_visible()
    look.hover()
    page.mouse.down()
    asked.pop().fulfill(json=scenes.INCIDENTS)
    expect(dialog.get_by_role("row").nth(1)).to_be_visible()
    page.mouse.up()
    expect(page.get_by_role("dialog", name="Dispatch 2026/7")).to_be_visible()
