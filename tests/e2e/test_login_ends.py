"""An ended login: the open work waits for the same user, and for no other."""

from __future__ import annotations

import re

from playwright.sync_api import Locator, Page, expect

from tests.e2e import scenes
from tests.e2e.console_page import menu
from tests.e2e.layout_checks import flaws
from tests.e2e.played_station import PlayedStation
from tests.e2e.stage import ANSWERS, Stage

CHIEF = {"username": "chief", "role": "administrator"}
ENDED = "This login has ended"


def answers(username: str = "chief") -> dict[str, object]:
    return {**ANSWERS, "POST /login": {**CHIEF, "username": username}}


def log_in(page: Page, username: str = "chief") -> None:
    page.get_by_label("User").fill(username)
    page.get_by_label("Password").fill("any")
    page.get_by_role("button", name="Log in").click()
    expect(people(page)).to_be_visible()


def people(page: Page) -> Locator:
    return page.get_by_role("region", name="People")


def write_a_message(page: Page) -> Locator:
    page.get_by_role("group", name="Commands").get_by_role("button", name="Message").click()
    text = page.get_by_role("dialog").get_by_label("Message", exact=True)
    text.press_sequentially("Leave by the north stairs")
    return text


def test_unsent_message_is_kept_over_a_login(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute(), answers=answers())
    text = write_a_message(page)
    station.end_logins()
    expect(page.get_by_role("status").filter(has_text=ENDED)).to_be_visible()
    expect(page.get_by_role("dialog")).to_be_hidden()
    expect(people(page)).to_be_hidden()
    expect(page.get_by_label("User")).to_be_focused()
    page.keyboard.press("Escape")
    log_in(page)
    expect(text).to_have_value("Leave by the north stairs")
    expect(text).to_be_focused()
    page.keyboard.type(" now")
    page.get_by_role("dialog").get_by_role("button", name="Send", exact=True).click()
    station.expect_changes("/login", "/commands")


def test_live_view_continues_after_the_login(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute(), answers=answers())
    station.end_logins()
    log_in(page)
    expect(page.get_by_test_id("link")).to_have_text("Connected")
    expect(page.locator(".console")).not_to_have_class(re.compile("not-now"))
    station.change(alarms=tuple(map(scenes.taken, station.picture.alarms)))
    alarms = page.get_by_role("region", name="Open alarms")
    expect(alarms.get_by_role("button", name="Resolve")).to_have_count(3)
    assert flaws(page) == []


def test_message_sent_after_the_end_of_the_login_is_kept(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute(), answers=answers())
    text = write_a_message(page)
    page.route(
        "**/api/v1/commands",
        lambda route: route.fulfill(status=401, json={"detail": "log in first"}),
    )
    page.get_by_role("dialog").get_by_role("button", name="Send", exact=True).click()
    expect(page.get_by_role("status").filter(has_text="log in first")).to_be_visible()
    log_in(page)
    expect(text).to_have_value("Leave by the north stairs")


def test_unsaved_pin_is_kept_over_a_login(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute(), answers=answers())
    card = page.locator(".card").first
    card.get_by_role("button").first.click()
    card.get_by_role("button", name="Correct position …").click()
    panel = page.get_by_role("form", name="Pin: Jonas Bergman")
    page.locator(".map").click(position={"x": 150, "y": 120})
    expect(panel.get_by_label("North, m")).not_to_have_value("")
    north = panel.get_by_label("North, m").input_value()
    panel.get_by_label("Note").fill("by the lift")
    station.end_logins()
    expect(page.get_by_role("status").filter(has_text=ENDED)).to_be_visible()
    page.keyboard.press("Escape")
    log_in(page)
    expect(panel.get_by_label("Note")).to_have_value("by the lift")
    expect(panel.get_by_label("North, m")).to_have_value(north)
    expect(panel.get_by_label("Note")).to_be_focused()


def replay_an_incident(stage: Stage, username: str = "chief") -> tuple[Page, PlayedStation]:
    """With a dialog over it; then the login ends."""
    page, station = stage.open(scenes.quiet(), answers=answers(username))
    menu(page, "Incidents").get_by_role("button", name=f"Replay {scenes.INCIDENT.name}").click()
    bar = page.get_by_role("region", name="Replay")
    expect(bar.get_by_role("button", name="Pause")).to_be_visible()
    page.locator(".par-clock").click()
    expect(page.get_by_role("dialog", name="PAR status")).to_be_visible()
    station.end_logins()
    expect(page.get_by_role("status").filter(has_text=ENDED)).to_be_visible()
    expect(bar).to_be_hidden()
    return page, station


def test_replay_continues_at_its_time_after_the_login(stage: Stage) -> None:
    page, station = replay_an_incident(stage)
    with page.expect_request("**/api/v1/replays/r2") as asked:
        log_in(page)
    at = scenes.past().replay
    assert at is not None
    wanted = {"at_ms": at.at_ms, "speed": at.speed, "playing": at.playing}
    assert asked.value.post_data_json == wanted
    expect(page.get_by_role("dialog", name="PAR status")).to_be_visible()
    expect(page.get_by_role("region", name="Replay")).to_contain_text("Recorded, not live")
    expect(page.locator(".console")).to_have_class(re.compile("replay"))
    expect(page.locator(".console")).not_to_have_class(re.compile("not-now"))
    station.expect_changes("/replays", "/login", "/replays/r2")


def test_replay_ended_by_the_station_is_opened_again(stage: Stage) -> None:
    """Nobody looked at it for a minute."""
    page, station = replay_an_incident(stage)
    gone = {"detail": "There is no such replay; it may have ended."}
    page.route("**/api/v1/replays/r2", lambda route: route.fulfill(status=404, json=gone))
    anew = scenes.replay("r3", begun_by="chief")
    page.route("**/api/v1/replays", lambda route: route.fulfill(json=anew))
    log_in(page)
    expect(page.locator(".console")).to_have_class(re.compile("replay"))
    expect(page.locator(".console")).not_to_have_class(re.compile("not-now"))
    expect(page.get_by_role("dialog", name="PAR status")).to_be_visible()
    station.expect_changes("/replays", "/login", "/replays/r3")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Back to live").click()
    station.expect_changes("/replays", "/login", "/replays/r3", "/replays/r3")
    expect(page.locator(".console")).to_have_class(re.compile("live"))


def test_replay_is_not_shown_to_another_user(stage: Stage) -> None:
    page, station = replay_an_incident(stage, "deputy")
    log_in(page, "deputy")
    expect(page.get_by_role("region", name="Replay")).to_have_count(0)
    expect(page.get_by_role("dialog")).to_have_count(0)
    station.expect_changes("/replays", "/login")


def test_unsent_text_is_not_shown_to_another_user(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute(), answers=answers("deputy"))
    write_a_message(page)
    station.end_logins()
    expect(page.get_by_role("status").filter(has_text=ENDED)).to_be_visible()
    log_in(page, "deputy")
    expect(page.get_by_role("dialog")).to_have_count(0)
    page.get_by_role("group", name="Commands").get_by_role("button", name="Message").click()
    text = page.get_by_role("dialog").get_by_label("Message", exact=True)
    expect(text).to_have_value("")


def test_logout_clears_unsent_input(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute(), answers=answers())
    page.locator(".card").first.get_by_role("button").first.click()
    page.get_by_role("button", name="Set common start").click()
    page.get_by_role("button", name="Account").click()
    page.get_by_role("dialog").get_by_role("button", name="Log out").click()
    expect(page.locator(".console")).to_have_count(0)
    log_in(page)
    expect(page.get_by_role("form")).to_have_count(0)
    expect(page.get_by_role("dialog")).to_have_count(0)
