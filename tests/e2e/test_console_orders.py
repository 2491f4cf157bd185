"""Orders of a commander at the console, and the display of their answers.

One story in several tests: they run in the order in which they stand here.
"""

from __future__ import annotations

import re

from playwright.sync_api import Locator, Page, expect

from tests.e2e.console_page import (
    barriers,
    close,
    command,
    confirm,
    press,
)
from tests.e2e.enlisting import NAME
from tests.e2e.wearable import Wearable

DELIVERED = re.compile("(?<!not )delivered")


def test_a_roll_call_is_received_and_acknowledged(
    page: Page, card: Locator, wearable: Wearable
) -> None:
    dialog = command(page, "PAR")
    dialog.get_by_role("button", name="Send").click()
    row = dialog.get_by_role("row", name=NAME)
    expect(row).to_contain_text(DELIVERED)
    close(dialog)
    expect(card).to_contain_text("PAR requested")
    bar = page.get_by_role("group", name="Commands")
    expect(bar).to_contain_text("0 of 1 acknowledged")
    wearable.acknowledge()
    expect(bar).not_to_contain_text("acknowledged")
    dialog = command(page, "PAR")
    expect(row).to_contain_text(f"acknowledged{NAME}, own unit")
    close(dialog)


def test_confirmation_of_par_by_radio_can_be_undone(page: Page, card: Locator) -> None:
    clock = page.get_by_role("button", name="PAR in")
    expect(clock).to_contain_text(re.compile(r"PAR in \d+\s(min|s)"))
    clock.click()
    dialog = page.get_by_role("dialog")
    row = dialog.get_by_role("listitem").filter(has_text=NAME)
    expect(row).to_contain_text("by own unit")
    press(row.get_by_role("button", name=f"Confirm by radio: {NAME}"))
    expect(row).to_contain_text("by radio, entered by admin")
    dialog.get_by_role("status").get_by_role("button", name="Undo").click()
    expect(row).to_contain_text("by own unit")
    press(row.get_by_role("button", name=f"Confirm by radio: {NAME}"))
    row.get_by_role("button", name="Undo").click()
    page.wait_for_timeout(600)
    row.get_by_role("button", name="Yes, undo").click()
    expect(row).to_contain_text("by own unit")
    close(dialog)
    expect(card).to_contain_text(re.compile(r"PAR due in (10|9)\smin"))


def test_rare_actions_are_on_the_chosen_card(page: Page, card: Locator, wearable: Wearable) -> None:
    card.get_by_role("button", name=NAME).click()
    actions = card.get_by_role("group", name=f"For {NAME}")
    actions.get_by_role("button", name="To rehab").click()
    expect(card).to_contain_text("In rehab")
    actions.get_by_role("button", name="Return to duty").click()
    expect(card).to_contain_text("Inside for")
    actions.get_by_role("button", name="Sound locator").click()
    dialog = command(page, "Message")
    expect(dialog.get_by_role("table", name="Locate")).to_contain_text(DELIVERED)
    close(dialog)
    wearable.notify("sound")
    expect(card.locator(".card-commands")).to_contain_text("sounds since")
    press(actions.get_by_role("button", name="Stop sound locator"))
    expect(card.locator(".card-commands")).to_contain_text("stopped")
    press(actions.get_by_role("button", name="Sound locator"))
    expect(card.locator(".card-commands")).to_contain_text(DELIVERED)
    wearable.notify("light")
    expect(card.locator(".card-commands")).to_contain_text("no sound")
    wearable.acknowledge()
    expect(card.locator(".card-commands")).to_contain_text("stopped by the wearer")


def test_an_evacuation_is_answered_by_radio_sent_again_and_ended_by_the_all_clear(
    page: Page, card: Locator, wearable: Wearable
) -> None:
    dialog = command(page, "Evacuate")
    expect(card).not_to_contain_text("Evacuate")
    dialog.get_by_role("button", name="Evacuate now").click()
    row = dialog.get_by_role("row", name=NAME).first
    expect(row).to_contain_text(DELIVERED)
    press(row.get_by_role("button", name="Send again"))
    expect(dialog).to_contain_text("sent again")
    expect(row).to_contain_text(DELIVERED)
    expect(dialog.locator("caption")).to_contain_text("0 of 1 acknowledged")
    answered = row.get_by_role("button", name=f"Confirm by radio: {NAME}")
    press(answered)
    expect(row).to_contain_text("acknowledgedby radio, admin")
    dialog.get_by_role("status").get_by_role("button", name="Undo").click()
    press(answered)
    expect(row).to_contain_text("acknowledgedby radio, admin")
    close(dialog)
    dialog = command(page, "Evacuate")
    expect(dialog.get_by_role("table")).to_contain_text("acknowledged")  # and stands
    assert barriers(page) == []
    confirm(dialog, "All clear")
    expect(dialog.get_by_role("table", name="All clear")).to_contain_text(DELIVERED)
    wearable.acknowledge()
    expect(dialog.get_by_role("table", name="All clear")).to_contain_text("own unit")
    expect(dialog.get_by_role("table", name="Evacuate")).to_have_count(0)
    close(dialog)
    dialog = command(page, "Evacuate")
    expect(dialog.get_by_role("table")).to_have_count(0)  # it is over, and this would be another
    close(dialog)


def test_a_message_stays_on_the_card_until_it_is_answered(page: Page, card: Locator) -> None:
    dialog = command(page, "Message")
    dialog.get_by_label("To").select_option(label="Ladder 1")
    dialog.get_by_label("Message", exact=True).fill("Come to the stairs")
    dialog.get_by_role("button", name="Send").click()
    close(dialog)
    expect(card).to_contain_text("Message: Come to the stairs")


def test_unit_reports_that_it_cannot_notify_and_later_that_it_has(
    page: Page, card: Locator, wearable: Wearable
) -> None:
    wearable.describe()
    expect(card.locator(".not-notifiable")).to_have_text("cannot be notified")
    dialog = command(page, "PAR")
    expect(dialog).to_contain_text(f"1 of 1 cannot be notified: use the voice radio: {NAME}")
    dialog.get_by_role("button", name="Send").click()
    order = dialog.get_by_role("table").first
    expect(order.locator("caption")).to_contain_text("0 of 1 acknowledged, 1 cannot be notified")
    wearable.describe("led")
    expect(order.get_by_role("row", name=NAME)).to_contain_text(DELIVERED)
    wearable.notify()
    expect(order.get_by_role("row", name=NAME)).to_contain_text("signalled by the unit")
    close(dialog)
    expect(card.locator(".not-notifiable")).to_have_count(0)


def test_roll_call_and_plan_are_accessible(page: Page, card: Locator) -> None:
    page.get_by_role("button", name="PAR in").click()
    assert barriers(page) == []
    close(page.get_by_role("dialog"))
    card.get_by_role("button", name="Correct position …").click()
    assert barriers(page) == []
    page.keyboard.press("Escape")
