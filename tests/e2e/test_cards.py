"""Cards: people in danger come first, and each card shows its person's state."""

from __future__ import annotations

import re

import msgspec
from playwright.sync_api import expect

from base_station.views import wire
from tests.e2e import scenes
from tests.e2e.console_page import menu, painted, strip
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage


def test_endangered_members_are_first_and_complete_among_forty(stage: Stage) -> None:
    page, _ = stage.open(scenes.crowd())
    cards = page.locator(".card")
    expect(cards).to_have_count(42)
    expect(cards.first).to_contain_text("Jonas Bergman")
    expect(cards.first).to_contain_text("Fall")
    expect(cards.first.get_by_text("Battery")).to_be_visible()
    calm = page.locator(".card.normal", has_text="Astrid Lindqvist 2")
    expect(calm).to_have_class(re.compile("brief"))
    calm.get_by_role("button").click()
    expect(calm).not_to_have_class(re.compile("brief"))  # who is chosen is shown whole


def test_last_activity_of_a_silent_member_shows_its_age(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    silent = page.locator(".card", has_text="Tomas Novak").locator(".activity")
    expect(silent).to_contain_text("1 min old")
    received = page.locator(".card", has_text="Mira Okafor").locator(".activity")
    expect(received).to_have_text("Walking")


def test_screen_reader_separates_figure_and_unit(stage: Stage) -> None:
    shown = scenes.bad_minute()
    low = scenes.alarm(1, "battery", 2, "The battery of Jonas Bergman's unit is at 7 %", 5)
    units = (shown.units[0], scenes.with_alarms(shown.units[1], low), *shown.units[2:])
    alarms = (*shown.alarms, low)
    page, _ = stage.open(msgspec.structs.replace(shown, units=units, alarms=alarms))
    hot = page.locator(".card", has_text="Mira Okafor").get_by_role("definition")
    expect(hot.filter(has_text="186")).to_have_text("186 °C warning")
    flat = page.locator(".card", has_text="Jonas Bergman").get_by_role("definition")
    expect(flat.filter(has_text="%")).to_have_text("7 % low")


def test_unit_switched_off_normally_is_not_highlighted(stage: Stage) -> None:
    """Its wearer is looked for by nobody: no hatching, no doubt, no place above those at work."""
    page, _ = stage.open(scenes.switched_off())
    cards = page.locator(".card")
    expect(cards.locator(".name").first).to_have_text("Astrid Lindqvist")  # by name
    for name in ("Astrid Lindqvist", "Jonas Bergman"):
        card = cards.filter(has_text=name)
        expect(card).to_have_class(re.compile(r"\bnormal\b"))
        expect(card).not_to_have_class(re.compile("unheard"))
        assert card.evaluate("card => getComputedStyle(card).backgroundImage") == "none"
        expect(card).to_contain_text("Switched off")
        expect(card).to_contain_text("10 min old")
        expect(card).not_to_contain_text("trust")
    page.get_by_role("button", name="Floors: All").click()
    page.wait_for_timeout(600)  # the plan has come to rest
    assert painted(page, "--quiet") < 4000, "the plan is not hatched for them"


def test_chosen_card_is_visible_with_all_its_actions(stage: Stage) -> None:
    page, _ = stage.open(scenes.crowd())
    lost = scenes.crowd().alarms[3]
    page.locator(".card").last.scroll_into_view_if_needed()
    strip(page).get_by_role("button", name=lost.text).first.click()
    actions = page.get_by_role("group", name="For Tomas Novak")
    expect(actions).to_be_in_viewport(ratio=1)
    expect(page.locator(".card.chosen .name")).to_be_in_viewport(ratio=1)
    page.locator(".card.normal").nth(5).get_by_role("button").first.click()  # at the lower edge
    expect(page.locator(".card-actions")).to_be_in_viewport(ratio=1)


def test_actions_stay_visible_on_low_screens(stage: Stage) -> None:
    """And however long the card grows while it is looked at."""
    page, station = stage.open(scenes.crowd(), "large at 200 %")
    page.locator(".card", has_text="Tomas Novak").get_by_role("button").first.click()
    actions = page.get_by_role("group", name="For Tomas Novak")
    expect(actions).to_be_in_viewport(ratio=1)
    lost = station.picture.units[3]
    fault = scenes.alarm(3, "unit-fault", 2, f"Tomas Novak's unit: {scenes.FAULTS[1]}", 1)
    station.change(alarms=(fault,), units=(scenes.with_alarms(lost, fault),))
    expect(page.locator(".card.chosen")).to_contain_text(scenes.FAULTS[1])
    expect(actions).to_be_in_viewport(ratio=1)
    expect(actions.get_by_role("button", name="Message")).to_be_in_viewport(ratio=1)


def test_overdue_member_is_marked_once(stage: Stage) -> None:
    page, station = stage.open(scenes.overdue())
    card = page.locator(".card", has_text=scenes.NAMES[0])
    expect(card).to_contain_text(re.compile(r"PAR overdue \d+:\d+"))
    expect(card.get_by_label("Open alarms of this person")).to_have_count(0)
    received = scenes.unit(0).duty
    late = station.picture.units[0]
    station.change(units=(msgspec.structs.replace(late, duty=received),))
    open_alarms = card.get_by_label("Open alarms of this person")
    expect(open_alarms.get_by_role("listitem")).to_have_text(["PAR overdue"])


def test_faults_of_a_unit_are_distinguished(stage: Stage) -> None:
    page, _ = stage.open(scenes.two_faults())
    card = page.locator(".card", has_text="Mira Okafor")
    faults = card.get_by_label("Open alarms of this person").get_by_role("listitem")
    expect(faults).to_have_text([f"Unit fault: {fault}" for fault in scenes.FAULTS])
    first, second = scenes.FAULTS
    expect(strip(page)).to_contain_text(f"Mira Okafor's unit: {first} + Unit fault: {second}")
    assert flaws(page) == []


def test_card_shows_alarms_of_the_previous_wearer(stage: Stage) -> None:
    """Bo is well; nobody is to look for him because of what was never resolved."""
    shown = scenes.bad_minute()
    wears_now = msgspec.structs.replace(shown.units[1], person=scenes.person(7))
    page, _ = stage.open(
        msgspec.structs.replace(shown, units=(shown.units[0], wears_now, *shown.units[2:]))
    )
    alarms = page.locator(".card", has_text="Li Na").get_by_label("Open alarms of this person")
    expect(alarms.get_by_role("listitem")).to_have_text(
        ["Fall (who wore it before)", "No motion (who wore it before)"], use_inner_text=True
    )


def test_switched_off_unit_shows_the_time_inside(stage: Stage) -> None:
    page, station = stage.open(scenes.switched_off())
    card = page.locator(".card", has_text="Jonas Bergman")
    expect(card).to_contain_text("Was inside4 min")
    station.change(now_ms=scenes.NOW_MS + 20 * scenes.MINUTE_MS)
    expect(card).to_contain_text("30 min ago")
    expect(card).to_contain_text("Was inside4 min")


def test_assignment_options_name_the_current_unit_of_members(stage: Stage) -> None:
    """Chosen by a slip, they would be looked for where that unit is."""
    page, _ = stage.open(scenes.quiet())
    worn_by = menu(page, "Units").get_by_label("Assign FF-01 to")
    worn_by.focus()
    options = worn_by.get_by_role("option")
    expect(options.filter(has_text="Jonas Bergman")).to_have_text(
        "Jonas Bergman (Engine 2), wears FF-02"
    )
    expect(options.filter(has_text="Astrid Lindqvist")).to_have_text("Astrid Lindqvist (Engine 1)")


def test_phone_shows_either_list_or_plan(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute(), "phone")
    people, plan = page.get_by_role("region", name="People"), page.locator(".map")
    expect(people).to_be_visible()
    expect(plan).to_be_hidden()
    strip(page).locator(".what").first.click()
    expect(plan).to_be_visible()
    expect(people).to_be_hidden()
    page.get_by_role("button", name="Menu").click()
    page.get_by_role("navigation").get_by_role("button", name="Units").click()
    expect(page.get_by_role("dialog")).to_be_visible()


def test_unit_that_is_not_ready_is_marked_and_warnings_are_on_the_chosen_card(
    stage: Stage,
) -> None:
    shown = scenes.bad_minute()
    found = (
        wire.PreflightView("failed", "battery: no reading"),
        wire.PreflightView("warning", "output: the unit has none"),
        None,
    )
    checked = tuple(
        msgspec.structs.replace(unit, preflight=preflight)
        for unit, preflight in zip(shown.units, found, strict=False)
    )
    units = (*checked, *shown.units[len(checked) :])
    page, _ = stage.open(msgspec.structs.replace(shown, units=units))
    broken, weak, unknown = (
        page.locator(f'.card[data-unit="{unit.unit_id}"]') for unit in units[:3]
    )
    expect(broken).to_contain_text("Unit not ready: battery: no reading")
    expect(unknown).not_to_contain_text("ready")
    expect(weak).not_to_contain_text("with warnings")
    weak.get_by_role("button").first.click()
    expect(weak).to_contain_text("Unit with warnings: output: the unit has none")
    menu(page, "Units")
    table = page.get_by_role("table")
    expect(table).to_contain_text("not ready: battery: no reading")
    expect(table).to_contain_text("with warnings: output: the unit has none")
