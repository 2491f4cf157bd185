"""Orders to a crew and to a floor, and answers by radio with the user who entered them."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Locator, expect

from shared.messages import CommandKind
from tests.e2e.console_page import close, command, press, take_picture
from tests.e2e.crowd.incident import CREW_SIZE, NAMES, RESCUER, Incident, name_of
from tests.e2e.crowd.test_floors import floor_button, people_on
from tests.e2e.layout_checks import flaws
from tests.rig.waiting import until

CREW = "Ladder 2"
OF_CREW = [name_of(CREW_SIZE + place) for place in range(CREW_SIZE)]
CONFIRMED = re.compile(r"confirmed (\d\d:\d\d:\d\d)")
BY_RADIO = re.compile("by radio, (entered by )?admin")


def end(incident: Incident, dialog: Locator) -> None:
    """So that units wait for no evacuation any more, and no PAR is due soon."""
    dialog.get_by_role("button", name="All clear", exact=True).click()
    press(dialog.get_by_role("button", name="Yes, all clear"))
    expect(dialog).to_contain_text("All clear (")
    close(dialog)
    incident.confirm_par()


def test_crew_is_evacuated_and_members_without_an_answer_are_first(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    dialog = command(page, "Evacuate")
    dialog.get_by_role("combobox", name="To").select_option(label=CREW)
    dialog.get_by_role("button", name="Evacuate now").click()
    caption = dialog.locator("caption", has_text="Evacuate")
    expect(caption).to_contain_text(f"0 of {CREW_SIZE} acknowledged")
    expect(caption).to_contain_text(f"{CREW_SIZE} cannot be notified")
    table = dialog.get_by_role("table", name="Evacuate")
    assert sorted(table.get_by_role("rowheader").all_inner_texts()) == sorted(OF_CREW)
    answered = table.get_by_role("rowheader").first.inner_text()
    press(table.get_by_role("button", name=f"Confirm by radio: {answered}"))
    expect(caption).to_contain_text(f"1 of {CREW_SIZE} acknowledged")
    expect(table.get_by_role("row", name=answered)).to_contain_text(BY_RADIO)
    expect(table.get_by_role("rowheader").last).to_have_text(answered)
    press(dialog.get_by_role("button", name=re.compile(rf"^Send again to {CREW_SIZE - 1}\b")))
    expect(dialog).to_contain_text("sent again")
    take_picture(page, tmp_path, f"crew-{incident.people}.png")
    assert flaws(page) == []
    end(incident, dialog)


def test_floor_is_evacuated_and_a_unit_answers_by_itself(incident: Incident) -> None:
    page = incident.page
    floor_button(page, "Floor G").click()
    downstairs = people_on(page, "Floor G")
    dialog = command(page, "Evacuate")
    to = dialog.get_by_role("combobox", name="To")
    to.select_option(label="Ground floor, and whose floor is not known")
    dialog.get_by_role("button", name="Evacuate now").click()
    caption = dialog.locator("caption", has_text="Evacuate")
    expect(caption).to_contain_text(re.compile(r"0 of \d+ acknowledged"))
    found = re.search(r"of (\d+) acknowledged", caption.inner_text())
    assert found is not None
    assert abs(int(found[1]) - downstairs) <= 2  # people climb stairs meanwhile
    assert int(found[1]) < incident.people
    end(incident, dialog)


def test_wearers_own_answer_is_recorded_as_that(incident: Incident) -> None:
    page = incident.page
    dialog = command(page, "PAR")
    dialog.get_by_role("combobox", name="To").select_option(label=NAMES[RESCUER])
    dialog.get_by_role("button", name="Send", exact=True).click()
    order = dialog.get_by_role("table").first
    expect(order.locator("caption")).to_contain_text("of 1 acknowledged")
    until(lambda: incident.rescuer.kinds[-1:] == [CommandKind.PAR_REQUEST], "the order at the unit")
    incident.rescuer.acknowledge()
    expect(order.get_by_role("row", name=NAMES[RESCUER])).to_contain_text("own unit")
    close(dialog)


def test_par_of_a_crew_records_who_entered_it_and_is_undone(incident: Incident) -> None:
    page = incident.page
    page.locator(".par-clock").click()
    dialog = page.get_by_role("dialog", name="PAR status")
    crew = dialog.get_by_role("region", name=CREW, exact=True)
    expect(crew.get_by_role("listitem")).to_have_count(CREW_SIZE)
    before = CONFIRMED.findall(crew.inner_text())
    press(crew.get_by_role("button", name=f"{CREW}: confirm all"))
    undo = dialog.get_by_role("status").get_by_role("button", name="Undo")
    expect(undo).to_be_visible()
    until(lambda: CONFIRMED.findall(crew.inner_text()) != before, "the confirmation of the crew")
    for row in crew.get_by_role("listitem").all():
        expect(row).to_contain_text(BY_RADIO)
    undo.click()
    until(lambda: CONFIRMED.findall(crew.inner_text()) == before, "what was there before")
    own = dialog.get_by_role("listitem").filter(has_text=NAMES[RESCUER])
    expect(own).to_contain_text("by own unit")
    close(dialog)
    incident.confirm_par()
