"""Incidents: their times, and saving one as a file."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta
from urllib.parse import parse_qs, urlsplit

import msgspec
import pytest
from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import menu
from tests.e2e.stage import ANSWERS, PAST, Stage


def test_incident_is_saved_or_the_failure_is_shown(stage: Stage) -> None:
    saved = {
        f"{PAST}/export/csv?fused": "unit_id,person",
        f"{PAST}/export/csv?smoothed": "known since",
        f"{PAST}/incident.mcap": "all of it",
    }
    formats = [
        {"name": name, "suffix": name, "needs_anchor": name == "gpx"} for name in ("csv", "gpx")
    ]
    answers = {**ANSWERS, **saved, "/export-formats": formats}
    page, _ = stage.open(scenes.quiet(), answers=answers)
    dialog = menu(page, "Incidents")
    save_as = dialog.get_by_label(f"Save {scenes.INCIDENT.name} as a file")
    with page.expect_download() as download:
        save_as.select_option("csv fused")
    assert download.value.suggested_filename == f"{scenes.INCIDENT.incident_id}.csv"
    assert "unit_id,person" in download.value.path().read_text()
    with page.expect_download() as download:
        save_as.select_option("csv smoothed")
    assert download.value.suggested_filename == f"{scenes.INCIDENT.incident_id}-smoothed.csv"
    assert "known since" in download.value.path().read_text()
    with page.expect_download() as download:
        save_as.select_option("mcap")
    assert download.value.suggested_filename == f"{scenes.INCIDENT.incident_id}.mcap"
    assert "all of it" in download.value.path().read_text()
    save_as.select_option("gpx fused")
    expect(dialog.get_by_text("The station answered 404")).to_be_visible()
    expect(save_as).to_be_enabled()
    save_as.press("ArrowDown")
    save_as.press("ArrowDown")
    with page.expect_request(re.compile("/export/")) as asked:
        save_as.press("Enter")
    assert asked.value.url.endswith("/export/gpx?kind=fused"), (
        "what the keys passed is not asked for"
    )


def test_incident_starts_with_the_times_of_the_station(stage: Stage) -> None:
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), incident=None))
    dialog = menu(page, "Incidents")
    expect(dialog.get_by_label("PAR every, min")).to_have_value("15")
    dialog.get_by_label("Name of the new incident").fill("Mill Lane")
    dialog.get_by_label("Work limit, min").fill("30")
    with page.expect_request(lambda request: request.method == "POST") as sent:
        dialog.get_by_role("button", name="Open incident").click()
    assert sent.value.post_data_json == {
        "name": "Mill Lane",
        "par_interval_s": 900,
        "work_limit_s": 1800,
    }


def test_incidents_are_searched_for_by_words(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    dialog = menu(page, "Incidents")
    dialog.get_by_role("searchbox", name="Place, person or alarm").fill(" mayday &lane ")
    with page.expect_request(re.compile("/incidents\\?")) as sent:
        dialog.get_by_role("button", name="Search").click()
    assert parse_qs(urlsplit(sent.value.url).query)["text"] == ["mayday &lane"]
    expect(dialog.get_by_role("table", name="Incidents with: mayday &lane")).to_be_visible()


def test_times_with_seconds_are_kept(stage: Stage) -> None:
    incident = msgspec.structs.replace(scenes.INCIDENT, par_interval_s=90.0)
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), incident=incident))
    dialog = menu(page, "Incidents")
    dialog.get_by_label("Work limit, min").fill("30")
    with page.expect_request(lambda request: request.method == "PUT") as sent:
        dialog.get_by_role("button", name="Save times").click()
    assert sent.value.post_data_json == {"par_interval_s": 90, "work_limit_s": 1800}


def test_last_hour_is_by_the_clock_of_the_station(stage: Stage) -> None:
    page, station = stage.open(msgspec.structs.replace(scenes.quiet(), incident=None))
    page.clock.set_fixed_time(datetime.fromtimestamp(scenes.NOW_MS / 1000, UTC) + timedelta(days=2))
    station.change()
    dialog = menu(page, "Units")
    with page.expect_request(re.compile("/recordings$")) as sent:
        dialog.get_by_role("button", name="Download recording of FF-01").click()
    asked = sent.value.post_data_json
    assert asked is not None
    assert scenes.NOW_MS - asked["from_ms"] == pytest.approx(60 * scenes.MINUTE_MS, rel=0.1)
