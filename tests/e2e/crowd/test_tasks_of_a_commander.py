"""Tasks of a commander, and how many presses each takes.  ``test_set_up.py`` counts those of
enrolling a unit and of bringing a plan in.
"""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import expect

from shared.messages import CommandKind
from tests.e2e.console_page import Presses, close, command, menu, press, strip, take_picture
from tests.e2e.crowd.incident import DOWN, NAMES, Incident, name_of
from tests.e2e.layout_checks import flaws
from tests.rig.simulated_units import unit_names
from tests.rig.waiting import until

SOUGHT, SOUGHT_UNIT = name_of(30), unit_names(31)[-1]
GUARD_MS = 600  # a list takes no press of a user who meant what stood there before


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
    until(lambda: incident.down.kinds[-1:] == [CommandKind.LOCATE], "the order at the unit")
    incident.down.notify("sound")
    expect(card.locator(".card-commands")).to_contain_text("sounds since")


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
    press(dialog.get_by_role("button", name="Yes, all clear"))
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
    press(row.get_by_role("button", name="Yes, answered by radio"))
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
    incident.confirm_par()
