"""Set-up at the vehicle, on a station: one story in the order of the tests.

It takes the pictures of docs/howto/set-up-at-the-vehicle.md.  The number of presses is part of it:
who sets up has a minute.  A press is a click on the page; to
choose a file counts as one, to write does not.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from ezdxf.filemanagement import new
from PIL import Image
from playwright.sync_api import Browser, FilePayload, Locator, Page, expect

from shared.enrolment import read_enrolment
from tests.e2e.console_page import (
    Presses,
    barriers,
    close,
    confirm,
    drawn,
    menu,
    take_picture,
)
from tests.e2e.drawn_paper import click_paper, scan
from tests.e2e.station_process import StationProcess
from tests.rig.ifc_house import house_of_two_storeys
from tests.rig.station_command import Agent

CREWS = "\ufeffName;Trupp;Dienstgrad\r\nJürgen Groß;Engine 1;Officer\r\nBo Li;Engine 1;\r\n"


@pytest.fixture(scope="module")
def station(
    chromium: Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[StationProcess]:
    """One that enrols; not started where there is no browser to look at it."""
    station = StationProcess(tmp_path_factory.mktemp("e2e") / "station", enrols=True)
    station.start()
    yield station
    station.stop()


def choose_csv(dialog: Locator, content: bytes) -> Locator:
    """The look at the file that follows."""
    file = FilePayload(name="crews.csv", mimeType="text/csv", buffer=content)
    dialog.get_by_label("People from a CSV file").set_input_files(file)
    return dialog.get_by_role("region", name="People of the file")


def test_crews_of_a_file_are_previewed_and_added(
    page: Page, tmp_path: Path, complaints: list[str]
) -> None:
    presses = Presses(page)
    dialog = menu(page, "People")
    found = choose_csv(dialog, CREWS.encode())
    expect(found).to_contain_text("2 people: 2 new")
    expect(dialog.get_by_text("Nobody yet")).to_be_visible()
    assert barriers(page) == []
    take_picture(dialog, tmp_path, "people.png")
    found.get_by_role("button", name="Add 2 people").click()
    expect(found).to_have_count(0)
    assert presses.count(files=1) == 3
    expect(dialog.get_by_role("row", name="Jürgen Groß")).to_contain_text("Officer")


def test_a_faulty_line_is_named_and_no_person_is_added(
    page: Page, complaints: list[str], tmp_path: Path
) -> None:
    dialog = page.get_by_role("dialog", name="People")
    found = choose_csv(dialog, b"Name,Crew\nNoa Sun,Engine 2\n,Engine 2\nbo  li,E\n")
    expect(found.get_by_role("alert")).to_contain_text("Line 3: the name is missing.")
    expect(found).to_contain_text("1 new, 1 changed")
    expect(found.get_by_role("button", name="Add")).to_have_count(0)
    page.screenshot(path=tmp_path / "faults.png")
    found.get_by_role("button", name="Cancel").click()
    choose_csv(dialog, b"PK\x03\x04workbook")
    notice = dialog.get_by_role("alert").filter(has_text="is a workbook")
    notice.get_by_role("button", name="OK").click()
    complaints[:] = [one for one in complaints if "/people/import" not in one]
    found = choose_csv(dialog, b"Name,Crew\nNoa Sun,Engine 2\nBo Li,Engine 2\n")
    found.get_by_role("button", name="Add and change 2 people").click()
    expect(found).to_have_count(0)
    expect(dialog.get_by_role("row", name="Bo Li")).to_contain_text("Engine 2")


def crew(dialog: Locator, name: str) -> Locator:
    return dialog.get_by_role("region", name=name, exact=True)


@pytest.fixture(scope="module")
def board(page: Page) -> Locator:
    dialog = page.get_by_role("dialog", name="People")
    dialog.get_by_role("button", name="Crews").click()
    crew(dialog, "Engine 1").wait_for()
    return dialog


def test_people_are_dragged_to_another_crew(board: Locator) -> None:
    bo = board.get_by_role("button", name="Bo Li")
    bo.drag_to(crew(board, "Engine 1"))
    expect(crew(board, "Engine 1").get_by_role("button", name="Bo Li")).to_be_visible()
    expect(crew(board, "Engine 2").get_by_role("listitem")).to_have_count(1)


def test_people_are_moved_to_another_crew_without_dragging(
    board: Locator, page: Page, tmp_path: Path
) -> None:
    """By keys, and on a screen that is touched."""
    board.get_by_label("New crew").fill("Ladder 1")
    board.get_by_role("button", name="Add crew").click()
    for name in ("Bo Li", "Noa Sun"):
        board.get_by_role("button", name=name).focus()
        page.keyboard.press("Enter")
    assert barriers(page) == []
    take_picture(board, tmp_path, "crews.png")
    board.get_by_role("button", name="Move here: Ladder 1").click()
    expect(crew(board, "Ladder 1").get_by_role("listitem")).to_have_count(2)
    expect(crew(board, "Engine 2")).to_have_count(0)


def test_dropped_picture_becomes_the_photo_of_the_person(
    board: Locator, page: Page, tmp_path: Path
) -> None:
    written = io.BytesIO()
    Image.new("RGB", (64, 64), "orange").save(written, "PNG")
    dropped = page.evaluate_handle(
        """(bytes) => {
          const transfer = new DataTransfer();
          transfer.items.add(new File([new Uint8Array(bytes)], "bo.png", { type: "image/png" }));
          return transfer;
        }""",
        list(written.getvalue()),
    )
    bo = board.get_by_role("button", name="Bo Li")
    bo.dispatch_event("drop", {"dataTransfer": dropped})
    expect(bo.locator("img.photo")).to_be_visible()
    close(board)


def test_unit_enrolled_in_three_presses_links_with_its_file(
    page: Page, station: StationProcess, tmp_path: Path, complaints: list[str]
) -> None:
    presses = Presses(page)
    menu(page, "Units").get_by_role("button", name="Enrolments").click()
    dialog = page.get_by_role("dialog", name="Enrolments")
    dialog.get_by_label("Unit id").fill("FF-33")
    dialog.get_by_role("button", name="Enrol unit").click()
    shown = dialog.get_by_role("region", name="Enrolment of FF-33")
    expect(shown.get_by_role("img", name="QR code")).to_be_visible()
    assert presses.count() == 3
    with page.expect_download() as saving:
        shown.get_by_role("button", name="Save as file").click()
    file = tmp_path / saving.value.suggested_filename
    saving.value.save_as(file)
    expect(shown).to_contain_text(f"muster edge run --enrolment {file.name}")
    take_picture(dialog, tmp_path, "enrolment.png")
    assert kept_of(station.data, read_enrolment(file).identity.private_key) == []
    shown.get_by_role("button", name="Done").click()
    page.wait_for_timeout(600)
    shown.get_by_role("button", name="Yes, it has it").click()
    close(dialog)
    unit = ("--enrolment", str(file), "--source", "simulated:straight")
    data = ("--data", str(tmp_path / "unit"), "--tracker", "none")
    with Agent(tmp_path / "unit.txt", *unit, *data):
        page.locator("[data-unit='FF-33']").wait_for()


def kept_of(data: Path, key: bytes) -> list[Path]:
    """Files of the station with any line of the key."""
    lines = [line for line in key.splitlines() if b"-" not in line]
    return [
        path
        for path in data.rglob("*")
        if path.is_file() and any(line in path.read_bytes() for line in lines)
    ]


def test_a_picture_becomes_a_plan_in_six_presses(
    page: Page, station: StationProcess, tmp_path: Path, complaints: list[str]
) -> None:
    presses = Presses(page)
    site = menu(page, "Site")
    file = FilePayload(name="Mill Road 7.png", mimeType="image/png", buffer=scan())
    site.get_by_label("New plan").set_input_files(file)
    paper = site.get_by_role("application", name="Paper")
    paper.wait_for()
    click_paper(paper, 100, 500)
    click_paper(paper, 900, 500)
    site.get_by_label("Distance, m").fill("40")
    expect(site.get_by_role("status").filter(has_text="1 m is 20.0 pixels")).to_be_visible()
    assert barriers(page) == []
    take_picture(site, tmp_path, "scaled.png")
    site.get_by_role("button", name="Set plan").click()
    expect(site).to_have_count(0)
    assert presses.count(files=1) <= 6
    (picture,) = plan_of(page)["muster"]["pictures"]
    assert picture["upper_left_m"] == pytest.approx([-5.0, 25.0], abs=0.1)
    assert picture["upper_right_m"] == pytest.approx([45.0, 25.0], abs=0.1)
    drawn(page)
    page.screenshot(path=tmp_path / "plan.png")


def plan_of(page: Page) -> dict[str, Any]:
    """As the station has it."""
    answer = page.request.get(f"{page.url}api/v1/site/plan")
    plan: dict[str, Any] = answer.json()
    return plan


def test_walls_are_drawn_on_the_picture_of_another_floor_by_mouse_and_keys(
    page: Page, tmp_path: Path, complaints: list[str]
) -> None:
    site = menu(page, "Site")
    written = io.BytesIO()
    pages = [Image.new("RGB", (200, 200), "white"), Image.open(io.BytesIO(scan()))]
    pages[0].save(written, "PDF", save_all=True, append_images=pages[1:])
    file = FilePayload(name="floors.pdf", mimeType="application/pdf", buffer=written.getvalue())
    site.get_by_label("New plan").set_input_files(file)
    site.get_by_label("Page").select_option("2")
    paper = site.get_by_role("application", name="Paper")
    paper.wait_for()
    expect(paper).to_have_attribute("viewBox", re.compile("^0 0 2048 "))
    for x in (100, 900):
        click_paper(paper, x, 500)
    site.get_by_label("Distance, m").fill("40")
    site.get_by_label("Floor (0: ground)").fill("1")
    for x, y in ((500, 100), (500, 400)):
        click_paper(paper, x, y)
    site.get_by_role("button", name="Stairs").click()
    for x, y in ((100, 440), (160, 440), (160, 500)):
        click_paper(paper, x, y)
    paper.focus()
    for key in ("ArrowRight", "Enter"):
        page.keyboard.press(key)
    site.get_by_role("button", name="Undo").click()
    take_picture(site, tmp_path, "walls.png")
    confirm(site, "Replace plan")
    expect(site).to_have_count(0)
    plan = plan_of(page)
    assert [one["floor"] for one in plan["muster"]["pictures"]] == [0, 1]
    assert plan["muster"]["floors"][1] == {"floor": 1, "down_m": -3.2}
    wall, stairs = (one["geometry"]["coordinates"] for one in plan["features"])
    assert wall == [pytest.approx([20.0, 20.0], abs=0.2), pytest.approx([20.0, 5.0], abs=0.2)]
    assert len(stairs[0]) == 4


def test_walls_are_drawn_without_a_picture(page: Page, complaints: list[str]) -> None:
    site = menu(page, "Site")
    site.get_by_role("button", name="Draw walls").click()
    paper = site.get_by_role("application", name="Paper")
    paper.wait_for()
    for x in (20, 60):
        click_paper(paper, x, 30, 100)
    confirm(site, "Replace plan")
    expect(site).to_have_count(0)
    plan = plan_of(page)
    assert len(plan["muster"]["pictures"]) == 2
    assert [one["properties"]["kind"] for one in plan["features"]] == ["wall", "stairs", "wall"]


def test_ordinary_geojson_and_dxf_become_plans(page: Page, complaints: list[str]) -> None:
    site = menu(page, "Site")
    wall = b'{"type": "LineString", "coordinates": [[11.97, 57.7], [11.9704, 57.7]]}'
    features = b'[{"type": "Feature", "properties": {}, "geometry": %s}]' % wall
    geojson = b'{"type": "FeatureCollection", "features": %s}' % features
    file = FilePayload(name="osm.geojson", mimeType="application/geo+json", buffer=geojson)
    site.get_by_label("New plan").set_input_files(file)
    confirm(site, "Replace plan")
    expect(site).to_have_count(0)
    (east_m, _), (end_m, _) = plan_of(page)["features"][0]["geometry"]["coordinates"]
    assert end_m - east_m == pytest.approx(23.9, abs=0.1)
    site = menu(page, "Site")
    expect(site).to_contain_text("origin lies at 57.70000°, 11.97020°")
    document: Any = new(units=0)
    document.modelspace().add_line((0, 0), (1000, 0), dxfattribs={"layer": "Wall"})
    written = io.StringIO()
    document.write(written)
    dxf = written.getvalue().encode()
    file = FilePayload(name="house.dxf", mimeType="application/dxf", buffer=dxf)
    site.get_by_label("New plan").set_input_files(file)
    notice = site.get_by_role("alert").filter(has_text="does not say in which unit of length")
    notice.get_by_role("button", name="OK").click()
    complaints[:] = [one for one in complaints if "/site/drafts" not in one]
    site.get_by_label("Unit of length").select_option("cm")
    confirm(site, "Replace plan")
    expect(site).to_have_count(0)
    plan = plan_of(page)
    (wall_line,) = (one["geometry"]["coordinates"] for one in plan["features"])
    assert wall_line == [[0, 0], [10, 0]]
    assert plan["muster"]["name"] == "house"


def test_storeys_of_a_model_become_floors(
    page: Page, tmp_path: Path, complaints: list[str]
) -> None:
    house = house_of_two_storeys("IFC4", 0.001)
    house.site.RefLatitude, house.site.RefLongitude = (57, 42, 0), (11, 58, 12)
    site = menu(page, "Site")
    file = FilePayload(name="Mill Road 9.ifc", mimeType="model/ifc", buffer=house.content())
    presses = Presses(page)
    site.get_by_label("New plan").set_input_files(file)
    expect(site).to_contain_text("Its floors: 0 = Ground floor (0.00 m), 1 = Upper floor (3.00 m).")
    place = site.get_by_role("checkbox", name="place on the Earth: 57.70000°, 11.97")
    expect(place).not_to_be_checked()
    assert barriers(page) == []
    place.check()
    take_picture(site, tmp_path, "model.png")
    confirm(site, "Replace plan")
    expect(site).to_have_count(0)
    assert presses.count(files=1) == 4
    plan = plan_of(page)
    assert [one["down_m"] for one in plan["muster"]["floors"]] == [0.0, -3.0]
    floors = page.get_by_role("group", name="Floor shown")
    floors.get_by_role("button", name="Floor 1").click()
    drawn(page)
    take_picture(page, tmp_path, "floors.png")
    site = menu(page, "Site")
    expect(site).to_contain_text("origin lies at 57.70000°, 11.97000°")
    close(site)


def test_suggested_place_of_a_model_is_optional(page: Page, complaints: list[str]) -> None:
    house = house_of_two_storeys()
    house.site.RefLatitude, house.site.RefLongitude = (42, 21, 31), (-71, -3, -24)
    site = menu(page, "Site")
    file = FilePayload(name="Default.ifc", mimeType="", buffer=house.content())
    site.get_by_label("New plan").set_input_files(file)
    confirm(site, "Replace plan")
    expect(site).to_have_count(0)
    assert plan_of(page)["muster"]["name"] == "Default"
    site = menu(page, "Site")
    expect(site).to_contain_text("origin lies at 57.70000°, 11.97000°")
    close(site)


def test_a_drawing_that_cannot_be_read_is_refused_with_the_reason(
    page: Page, complaints: list[str]
) -> None:
    site = menu(page, "Site")
    file = FilePayload(name="house.png", mimeType="image/png", buffer=scan()[:300])
    site.get_by_label("New plan").set_input_files(file)
    notice = site.get_by_role("alert").filter(has_text="the picture cannot be read")
    notice.get_by_role("button", name="OK").click()
    complaints[:] = [one for one in complaints if "/site/drafts" not in one]
    close(site)
