"""The site dialog: an existing place or plan is replaced only after a confirmation."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest
from playwright.sync_api import Locator, expect

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


def paste(field: Locator, text: str) -> None:
    field.evaluate(
        """(field, text) => {
            const clipboardData = new DataTransfer();
            clipboardData.setData("text/plain", text);
            field.dispatchEvent(new ClipboardEvent("paste", { clipboardData, cancelable: true }));
        }""",
        text,
    )


@pytest.mark.parametrize("pair", ["57.7, 11.9", "57,7; 11,9"])
def test_pair_of_coordinates_is_pasted_into_one_field(stage: Stage, pair: str) -> None:
    page, station = stage.open(scenes.quiet())
    site = menu(page, "Site")
    paste(site.get_by_label("Latitude"), pair)
    expect(site.get_by_label("Latitude")).to_have_value("57.7")
    expect(site.get_by_label("Longitude")).to_have_value("11.9")
    with page.expect_request("**/site/anchor*") as sent:
        site.get_by_role("button", name="Save location").click()
    body = sent.value.post_data_json or {}
    assert (body["lat_deg"], body["lon_deg"]) == (57.7, 11.9)
    station.expect_changes("/site/anchor")


def test_text_that_is_no_coordinate_is_named_and_not_sent(stage: Stage, tmp_path: Path) -> None:
    page, station = stage.open(scenes.quiet())
    site = menu(page, "Site")
    latitude = site.get_by_label("Latitude")
    latitude.fill("Mill Road 7")
    site.get_by_label("Longitude").fill("11,9")
    reason = site.get_by_role("alert").filter(has_text="This is no latitude or longitude")
    expect(reason).to_be_visible()
    page.screenshot(path=tmp_path / "bad.png")
    assert flaws(page) == []
    site.get_by_role("button", name="Save location").click()
    station.expect_changes()
    latitude.fill("57,7")
    latitude.press("Enter")
    expect(reason).to_have_count(0)
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
