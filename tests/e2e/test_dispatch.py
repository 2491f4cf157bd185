"""From the dispatch centre to the plan: a station, its command, and a person who opens the
incident.

One story in several tests: they run in the order in which they stand here.
"""

from __future__ import annotations

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import msgspec
import pytest
from playwright.sync_api import Page, expect
from typer.testing import CliRunner

from base_station.app.dispatch_command import TOKEN_VARIABLE
from base_station.cli import app
from tests.e2e import scenes
from tests.e2e.console_page import answer_to, barriers, close, confirm, menu
from tests.e2e.stage import Stage
from tests.e2e.station_process import StationProcess

NUMBER = "2026/1234"
REPORT: dict[str, Any] = {
    "number": NUMBER,
    "type": "Structure fire",
    "type_code": "69D6",
    "address": "Main St 5",
    "units": ["E12", "L4"],
    "position": {"lat_deg": 52.5, "lon_deg": 13.4},
    "called": "2026-03-01T14:02:11+01:00",
    "dispatched": "2026-03-01T14:03:00",
    "remarks": "<b>two people</b> on the third floor",
}


@pytest.fixture(scope="module")
def token(page: Page) -> str:
    """For dispatch, and nothing else."""
    body = json.dumps({"name": "CAD", "role": "commander", "scopes": ["dispatch"]})
    answer = page.evaluate(
        "(body) => fetch('/api/v1/tokens', {method: 'POST', body,"
        " headers: {'Content-Type': 'application/json'}}).then((one) => one.json())",
        body,
    )
    return str(answer["token"])


def send(folder: Path, station: StationProcess, token: str, content: str) -> str:
    """With ``muster base dispatch``; gives what it prints."""
    file = folder / "report"
    file.write_text(content)
    arguments = ["dispatch", str(file), "--station", station.address]
    done = CliRunner().invoke(app, arguments, env={TOKEN_VARIABLE: token})
    assert done.exception is None, done.output
    return done.output


def test_dispatch_is_offered_with_its_known_details(
    page: Page, station: StationProcess, token: str, tmp_path: Path, complaints: list[str]
) -> None:
    reported = send(tmp_path, station, token, json.dumps(REPORT))
    assert "offered" in reported
    assert "not known at this station: E12, L4" in reported
    assert '"dispatched" has no time zone' in reported
    bar = page.get_by_role("status", name="Dispatch")
    expect(bar).to_contain_text(f"Dispatch {NUMBER}")
    expect(bar).to_contain_text("Structure fire, Main St 5, E12, L4")
    expect(page.get_by_role("heading", level=1)).to_have_text("No incident open")
    assert barriers(page) == []
    assert complaints == []


def test_a_person_opens_the_incident_and_accepts_the_position(page: Page) -> None:
    page.get_by_role("button", name="Open incident from dispatch").click()
    dialog = page.get_by_role("dialog")
    for words in (
        "Structure fire (69D6)",
        "Engine 12 (E12): not known at this station",
        "<b>two people</b> on the third floor",
        '"dispatched" has no time zone and is left out',
    ):
        expect(dialog).to_contain_text(words)
    expect(dialog.get_by_label("Name of the new incident")).to_have_value(
        "Structure fire, Main St 5"
    )
    expect(dialog.get_by_role("checkbox")).not_to_be_checked()
    assert barriers(page) == []
    dialog.get_by_role("checkbox").check()
    dialog.get_by_role("button", name="Open incident").click()
    expect(dialog).to_be_hidden()
    expect(page.get_by_role("heading", level=1)).to_have_text("Structure fire, Main St 5")
    expect(page.get_by_role("button", name=f"dispatch {NUMBER}")).to_be_visible()
    expect(page.get_by_role("status", name="Dispatch")).to_have_count(0)
    anchor = answer_to(page, "site/anchor")
    assert (anchor["lat_deg"], anchor["lon_deg"]) == (52.5, 13.4)


def test_updated_dispatch_changes_only_its_details(
    page: Page, station: StationProcess, token: str, tmp_path: Path
) -> None:
    update = REPORT | {"address": "Main St 7", "units": ["E12", "L4", "M3"], "ended": True}
    assert "updated" in send(tmp_path, station, token, json.dumps(update))
    assert "unchanged" in send(tmp_path, station, token, json.dumps(update))
    page.get_by_role("button", name=f"dispatch {NUMBER}").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("Main St 7")
    expect(dialog).to_contain_text("Medic 3 (M3)")
    expect(dialog).to_contain_text("ended by the dispatch centre")
    close(dialog)
    expect(page.get_by_role("heading", level=1)).to_have_text("Structure fire, Main St 5")


def test_second_dispatch_is_announced_and_moves_nothing(
    page: Page, station: StationProcess, token: str, tmp_path: Path
) -> None:
    orders = page.get_by_role("group", name="Commands").get_by_role("button")
    before = [button.bounding_box() for button in orders.all()]
    send(tmp_path, station, token, json.dumps({"number": "2026/1235", "address": "Mill Lane"}))
    expect(page.get_by_role("alert").filter(has_text="2026/1235")).to_be_visible()
    assert before
    assert [button.bounding_box() for button in orders.all()] == before
    page.get_by_role("alert").get_by_role("button", name="OK").click()
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name="Look at dispatch 2026/1235").click()
    looked_at = page.get_by_role("dialog", name="Dispatch 2026/1235")
    expect(looked_at).to_contain_text("is open. Close it to open an incident")
    looked_at.get_by_role("button", name="Dismiss").click()
    page.wait_for_timeout(600)
    looked_at.get_by_role("button", name="Yes, dismiss").click()
    expect(looked_at.get_by_role("button", name="Dismiss")).to_have_count(0)
    close(looked_at)


def test_an_alert_is_drawn_until_it_is_cancelled(
    page: Page, station: StationProcess, token: str, tmp_path: Path
) -> None:
    def alert(identifier: str, kind: str, references: str = "") -> str:
        expires = datetime.now(UTC) + timedelta(hours=1)
        return f"""<alert xmlns="urn:oasis:names:tc:emergency:cap:1.2">
            <identifier>{identifier}</identifier><sender>s</sender>
            <sent>2026-01-01T00:00:00Z</sent><status>Actual</status><msgType>{kind}</msgType>
            <references>{references}</references><info><event>Gas leak</event>
            <expires>{expires.isoformat()}</expires>
            <area><areaDesc>Works</areaDesc><circle>52.5,13.4 0.02</circle></area></info></alert>"""

    plan = page.locator(".map")
    without = plan.screenshot()
    assert "shown, 1 markers" in send(tmp_path, station, token, alert("a", "Alert"))
    page.wait_for_function("document.querySelector('.map canvas') !== null")
    for _ in range(100):
        page.wait_for_timeout(100)
        if plan.screenshot() != without:
            break
    assert plan.screenshot() != without
    page.screenshot(path=str(tmp_path / "alert.png"))
    cancel = alert("b", "Cancel", "s,a,2026-01-01T00:00:00Z")
    assert "cancelled" in send(tmp_path, station, token, cancel)


def test_dispatch_is_in_the_report_and_the_list_of_incidents(page: Page) -> None:
    confirm(menu(page, "Incidents"), "Close this incident")
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("row").filter(has_text=f"Dispatch {NUMBER}")).to_be_visible()
    (incident,) = answer_to(page, "incidents")
    report = page.evaluate(
        "(path) => fetch(path).then((answer) => answer.text())",
        f"/api/v1/incidents/{incident['incident_id']}/report.html",
    )
    assert f"Dispatch {NUMBER}: Structure fire (69D6); Main St 7" in report
    assert "units E12 L4 M3" in report
    close(dialog)


@pytest.mark.parametrize("screen", ["laptop", "phone"])
def test_long_dispatch_fits_and_several_are_counted(stage: Stage, screen: str) -> None:
    reports = tuple(
        scenes.dispatch(
            str(number),
            units=tuple(f"E{unit}" for unit in range(40)),
            type="Fire " * 30,
            address="x" * 200,
        )
        for number in range(3)
    )
    shown = msgspec.structs.replace(scenes.quiet(), incident=None, dispatches=reports)
    page, _ = stage.open(shown, screen)
    bar = page.get_by_role("status", name="Dispatch")
    expect(bar).to_contain_text("and 2 more")
    box, width = bar.bounding_box(), page.viewport_size
    assert box is not None
    assert width is not None
    assert box["width"] <= width["width"]
    assert box["height"] < width["height"] / 3
    expect(page.get_by_role("button", name="Open incident from dispatch")).to_be_in_viewport()
