"""PAR at the console: due members, confirmation questions, and undoing an entry."""

from __future__ import annotations

import re

import msgspec
import pytest
from playwright.sync_api import Page, expect

from base_station.views.wire import Snapshot
from tests.e2e import scenes
from tests.e2e.console_page import barriers, command, press
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import SCREENS, Stage

DOWN = "Jonas Bergman"
ALARMS = f"In alarm: {DOWN} (Fall, No motion). Has {DOWN} answered by radio?"


def just_opened() -> Snapshot:
    """Two who were never received, and three whose PAR was confirmed by radio."""
    shown = scenes.quiet()
    new = tuple(scenes.never_confirmed(one) for one in shown.units[:2])
    return msgspec.structs.replace(shown, units=(*new, *shown.units[2:]))


def roll_call(page: Page) -> None:
    page.locator(".par-clock").click()


@pytest.mark.parametrize("screen", SCREENS)
def test_member_without_a_message_is_not_shown_as_confirmed(stage: Stage, screen: str) -> None:
    page, _ = stage.open(just_opened(), screen)
    assert flaws(page) == []
    clock = page.locator(".par-clock")
    expect(clock).to_contain_text("2 not yet confirmed")
    expect(clock).not_to_have_class(re.compile("green"))
    card = page.locator(".card", has_text="Astrid Lindqvist")
    expect(card.locator(".par-mark")).to_have_text(
        re.compile(r"PAR due in 1[78]\smin.*not yet confirmed")
    )
    expect(card.locator(".par-mark")).not_to_have_class(re.compile("green"))
    expect(card).to_contain_text("not located")
    roll_call(page)
    assert flaws(page) == []
    row = page.get_by_role("dialog").get_by_role("listitem").filter(has_text="Astrid Lindqvist")
    expect(row).to_contain_text("not yet confirmed, not located")
    expect(row.get_by_role("button", name="Undo")).to_have_count(0)
    confirmed = page.get_by_role("dialog").get_by_role("listitem").filter(has_text="Mira Okafor")
    expect(confirmed).to_contain_text(
        re.compile(r"confirmed \d\d:\d\d:\d\d by radio, entered by chief")
    )


def test_confirmation_of_a_member_in_alarm_needs_a_second_press(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    roll_call(page)
    dialog = page.get_by_role("dialog")
    row = dialog.get_by_role("listitem").filter(has_text=DOWN)
    row.get_by_role("button", name="Confirm by radio").click()
    question = row.get_by_role("group", name=ALARMS)
    expect(question).to_be_visible()
    expect(question.get_by_role("button", name="No")).to_be_focused()
    assert flaws(page) == []
    assert barriers(page) == []
    station.expect_changes()
    page.wait_for_timeout(600)
    question.get_by_role("button", name="Yes, answered by radio").click()
    station.expect_changes("/check-ins")


def test_card_and_order_ask_for_the_second_press_too(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    card = page.locator(".card", has_text=DOWN)
    card.get_by_role("button", name=DOWN).click()
    card.get_by_role("button", name="PAR by radio").click()
    expect(card.get_by_role("group", name=ALARMS)).to_be_visible()
    assert flaws(page) == []
    card.get_by_role("button", name="No", exact=True).click()
    dialog = command(page, "PAR")
    row = dialog.get_by_role("row", name=DOWN)
    press(row.get_by_role("button", name="Confirm by radio"))
    expect(row.get_by_role("group", name=ALARMS)).to_be_visible()
    assert flaws(page) == []
    station.expect_changes()


# However busy the machine is, the press comes in the moment in which the words appear.
PRESS_AS_SOON_AS_SHOWN = """([words, name]) => {
    new MutationObserver((_, observer) => {
        const question = [...document.querySelectorAll("[role=group]")].find(
            (group) => group.textContent.includes(words),
        );
        const button = [...(question?.querySelectorAll("button") ?? [])].find(
            (one) => one.textContent.includes(name),
        );
        if (button === undefined) return;
        observer.disconnect();
        button.dispatchEvent(new MouseEvent("click", { bubbles: true, detail: 1 }));
        window.pressed = true;
    }).observe(document.body, { childList: true, subtree: true, characterData: true });
}"""


def test_new_alarm_restarts_the_confirmation(stage: Stage) -> None:
    """The press was meant for what stood there before."""
    shown = scenes.bad_minute()
    page, station = stage.open(shown)
    roll_call(page)
    row = page.get_by_role("dialog").get_by_role("listitem").filter(has_text=DOWN)
    row.get_by_role("button", name="Confirm by radio").click()
    page.wait_for_timeout(600)
    mayday = scenes.alarm(1, "mayday", 1, f"Mayday from {DOWN}", 0)
    down = shown.units[1]
    reported = msgspec.structs.replace(down, alarms=(*down.alarms, mayday.alarm_id))
    page.evaluate(PRESS_AS_SOON_AS_SHOWN, ["Mayday", "Yes, answered by radio"])
    station.change(alarms=(mayday,), units=(reported,))
    expect(row.get_by_role("group")).to_contain_text("Mayday")
    page.wait_for_function("() => window.pressed === true")
    station.expect_changes()


def test_confirmation_by_radio_can_be_undone_at_once_and_later(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    roll_call(page)
    dialog = page.get_by_role("dialog")
    row = dialog.get_by_role("listitem").filter(has_text="Astrid Lindqvist")
    with page.expect_request(re.compile("/check-ins$")) as sent:
        press(row.get_by_role("button", name="Confirm by radio"))
    entered = sent.value.post_data_json
    assert entered is not None
    undo = dialog.get_by_role("status").get_by_role("button", name="Undo")
    expect(dialog.get_by_text("PAR of Astrid Lindqvist: confirmed by radio")).to_be_visible()
    assert flaws(page) == []
    with page.expect_request(re.compile("/undo$")) as undone:
        undo.click()
    assert f"/check-ins/{entered['check_in_id']}/undo" in undone.value.url
    expect(undo).to_have_count(0)
    row.get_by_role("button", name="Undo: PAR of Astrid Lindqvist by radio").click()
    page.wait_for_timeout(600)
    with page.expect_request(re.compile("/check-ins/k0/undo$")) as later:
        row.get_by_role("button", name="Yes, undo").click()
    assert later.value.post_data_json == {"unit_id": "FF-01"}


def test_undo_button_disappears_after_its_time(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    page.clock.install()
    page.clock.pause_at(page.evaluate("Date.now()") + 1000)  # however slow the machine
    card = page.locator(".card", has_text="Astrid Lindqvist")
    card.get_by_role("button", name="Astrid Lindqvist").click()
    card.get_by_role("button", name="PAR by radio").click()
    undo = page.get_by_role("button", name="Undo", exact=True)
    expect(undo).to_be_visible()
    page.clock.run_for(10_100)
    expect(undo).to_have_count(0)
