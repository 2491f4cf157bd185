"""Set-up while the incident runs: crews of a file, one more unit, and a plan from a picture."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import FilePayload, expect

from tests.e2e.console_page import Presses, close, drawn, menu, press, take_picture
from tests.e2e.crowd.incident import Incident, crew_of, name_of
from tests.e2e.drawn_paper import click_paper, scan
from tests.e2e.layout_checks import flaws

NEW_PERSON, NEW_UNIT = "Zoe Quist", "FF-33"


def test_file_of_everybody_shows_what_it_would_change(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    crowd = incident.people - 2
    lines = ["Name,Crew,Role", *(f"{name_of(n)},{crew_of(n)}," for n in range(1, crowd))]
    lines += [f"{name_of(0)},Engine 7,", f"{NEW_PERSON},Engine 7,Officer"]
    dialog = menu(page, "People")
    expect(dialog.get_by_role("row", name=name_of(crowd - 1))).to_be_attached()
    file = FilePayload(name="crews.csv", mimeType="text/csv", buffer="\n".join(lines).encode())
    dialog.get_by_label("People from a CSV file").set_input_files(file)
    found = dialog.get_by_role("region", name="People of the file")
    expect(found).to_contain_text("1 new, 1 changed")
    take_picture(page, tmp_path, f"people-{incident.people}.png")
    assert flaws(page) == []
    press(found.get_by_role("button", name="Add and change 2 people"))
    expect(found).to_have_count(0)
    expect(dialog.get_by_role("row", name=NEW_PERSON)).to_contain_text("Engine 7")
    dialog.get_by_role("button", name="Crews").click()
    crew = dialog.get_by_role("region", name="Engine 7", exact=True)
    expect(crew.get_by_role("listitem")).to_have_count(2)
    take_picture(page, tmp_path, f"crew-board-{incident.people}.png")
    close(dialog)


def test_unit_is_enrolled_in_three_presses(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    presses = Presses(page)
    menu(page, "Units").get_by_role("button", name="Enrolments").click()
    dialog = page.get_by_role("dialog", name="Enrolments")
    dialog.get_by_label("Unit id").fill(NEW_UNIT)
    dialog.get_by_role("button", name="Enrol unit").click()
    shown = dialog.get_by_role("region", name=f"Enrolment of {NEW_UNIT}")
    expect(shown.get_by_role("img", name="QR code")).to_be_visible()
    assert presses.count() == 3
    take_picture(page, tmp_path, f"enrolment-{incident.people}.png")
    assert flaws(page) == []
    shown.get_by_role("button", name="Done").click()
    press(shown.get_by_role("button", name="Yes, it has it"))
    close(dialog)


def test_picture_becomes_the_plan_in_six_presses(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    presses = Presses(page)
    site = menu(page, "Site")
    file = FilePayload(name="Mill Road 7.png", mimeType="image/png", buffer=scan())
    site.get_by_label("New plan").set_input_files(file)
    paper = site.get_by_role("application", name="Paper")
    paper.wait_for()
    for x in (100, 900):
        click_paper(paper, x, 500)
    site.get_by_label("Distance, m").fill("40")
    site.get_by_role("button", name="Replace plan").click()
    press(site.get_by_role("button", name="Yes, replace plan"))
    expect(site).to_have_count(0)
    assert presses.count(files=1) <= 6
    page.get_by_role("button", name="Fit").click()
    drawn(page)
    take_picture(page, tmp_path, f"plan-{incident.people}.png")
    assert flaws(page) == []
