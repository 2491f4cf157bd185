"""The site dialog: an existing place or plan is replaced only after a confirmation."""

from __future__ import annotations

from pathlib import Path

import msgspec
from playwright.sync_api import expect

from base_station.views.wire import AnchorView
from tests.e2e import scenes
from tests.e2e.console_page import confirm, menu
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage


def test_replacing_the_place_of_a_plan_needs_confirmation(stage: Stage) -> None:
    """Whoever satellites have placed moves by it: it says by how far, and of another place anew."""
    anchor = AnchorView(57.7, 11.97, 0.0, 0.0)
    page, station = stage.open(msgspec.structs.replace(scenes.quiet(), anchor=anchor))
    site = menu(page, "Site")
    expect(site).to_contain_text("origin lies at 57.70000°, 11.97000°")
    latitude, asks = site.get_by_label("Latitude"), site.get_by_role("button", name="Save location")
    latitude.fill("57.701")
    latitude.press("Enter")
    question = site.get_by_role("group", name="Replace the location for everybody?")
    expect(question).to_contain_text("whoever satellites have placed moves by 111 m")
    expect(question.get_by_role("button", name="No")).to_be_focused()
    assert flaws(page) == []
    page.keyboard.press("Enter")
    expect(question).to_have_count(0)
    expect(asks).to_be_focused()
    asks.click()
    latitude.fill("57.702")
    expect(question).to_have_count(0)
    station.expect_changes()
    asks.click()
    expect(question).to_contain_text("moves by 223 m")
    page.wait_for_timeout(600)
    question.get_by_role("button", name="Yes, replace location").click()
    expect(site).to_have_count(0)
    station.expect_changes("/site/anchor")


def test_first_place_of_a_plan_is_set_without_confirmation(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    site = menu(page, "Site")
    expect(site).to_contain_text("The location of the plan is not known")
    for name in ("Latitude", "Longitude"):
        site.get_by_label(name).fill("11.5")
    site.get_by_role("button", name="Save location").click()
    expect(site).to_have_count(0)
    station.expect_changes("/site/anchor")


def test_replacing_a_plan_needs_confirmation(stage: Stage, tmp_path: Path) -> None:
    page, station = stage.open(scenes.bad_minute())
    site = menu(page, "Site")
    file = site.get_by_label("New plan")
    (tmp_path / "notes.json").write_text("notes")
    file.set_input_files(tmp_path / "notes.json")
    notice = site.get_by_role("alert").filter(has_text="This is not a GeoJSON file")
    notice.get_by_role("button", name="OK").click()
    (tmp_path / "yard.json").write_text(
        '{"type": "FeatureCollection", "features": [],'
        ' "muster": {"frame": "site-m", "name": "Yard", "floors": [{"floor": 0, "down_m": 0}]}}'
    )
    file.set_input_files(tmp_path / "yard.json")
    expect(site).to_contain_text("This file: Yard: 1 floor, 0 rooms")
    site.get_by_role("button", name="Replace plan").click()
    site.get_by_role("button", name="No").click()
    station.expect_changes()
    assert flaws(page) == []
    confirm(site, "Replace plan")
    expect(site).to_have_count(0)
    station.expect_changes("/site/plan")
