"""Replays that are looked at elsewhere: the console says whose they are, and who may ends them."""

from __future__ import annotations

from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import barriers, confirm, menu
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import ANSWERS, Stage

OPEN = {"/replays": [scenes.replay("r1", "mia"), scenes.replay("r2", "chief")]}


def test_commander_lists_open_replays_with_owners_and_ends_one(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet(), answers={**ANSWERS, **OPEN})
    table = menu(page, "Incidents").get_by_role("table", name="Replays that are open elsewhere")
    row = table.get_by_role("row", name="mia")
    expect(row).to_contain_text(scenes.INCIDENT.name)
    assert barriers(page) == []
    assert flaws(page) == []
    confirm(row, "End replay")
    station.expect_changes("/replays/r1")


def test_viewer_can_end_only_the_own_replay(stage: Stage) -> None:
    viewer = {"/me": {"username": "chief", "role": "viewer"}}
    page, _ = stage.open(scenes.quiet(), answers={**ANSWERS, **OPEN, **viewer})
    table = menu(page, "Incidents").get_by_role("table", name="Replays that are open elsewhere")
    expect(table.get_by_role("row", name="mia").get_by_role("button")).to_have_count(0)
    expect(table.get_by_role("row", name="chief").get_by_role("button")).to_have_count(1)
