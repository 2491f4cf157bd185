"""The timeline of a person at a real station, whose log has five minutes of three people."""

from __future__ import annotations

import re
from collections.abc import Iterator
from urllib.parse import parse_qs, urlsplit

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from shared.clock import NS_PER_MS
from tests.e2e.closed_incident import logged_in_page, station_after_incident
from tests.e2e.console_page import barriers, close, menu, press
from tests.e2e.station_process import StationProcess
from tests.rig.reported_incident import incident_records
from tests.rig.station_script import START_NS

START_MS = START_NS // NS_PER_MS
STRIPS = (
    "Temperature",
    "Height",
    "Floor",
    "Activity",
    "Battery",
    "Stated position error (DRMS)",
    "Link: time without a message",
)


@pytest.fixture(scope="module")
def station(
    chromium: Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[StationProcess]:
    folder = tmp_path_factory.mktemp("timeline")
    with station_after_incident(folder, incident_records()) as station:
        yield station


@pytest.fixture
def page(chromium: Browser, station: StationProcess) -> Iterator[Page]:
    with logged_in_page(chromium, station) as page:
        yield page


def open_timeline(page: Page, unit_id: str) -> Locator:
    card = page.locator(f"[data-unit='{unit_id}']")
    card.locator(".card-head, .line").first.click()
    card.get_by_role("button", name="Timeline").click()
    dialog = page.get_by_role("dialog")
    expect(dialog.locator("canvas")).to_have_count(len(STRIPS))
    return dialog


def span_of(url: str) -> tuple[int, int]:
    query = parse_qs(urlsplit(url).query)
    return int(query["from_ms"][0]), int(query["until_ms"][0])


def read_at(dialog: Locator, share: float) -> None:
    box = dialog.locator(".u-over").first.bounding_box()
    assert box is not None
    dialog.page.mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2)


def paused_replay(page: Page) -> Locator:
    """Open the replay; return its bar."""
    bar = page.get_by_role("region", name="Replay")
    incidents = menu(page, "Incidents")
    incidents.get_by_role("button", name="Replay Mill Lane 4").click()
    expect(bar.get_by_label("Time of the incident")).to_be_visible()
    if incidents.is_visible():
        close(incidents)
    bar.get_by_role("button", name="Pause").click()
    return bar


def test_timeline_and_replay_follow_each_other(page: Page) -> None:
    bar = paused_replay(page)

    dialog = open_timeline(page, "FF-03")
    for title in STRIPS:
        expect(dialog.get_by_role("region", name=title)).to_be_visible()
    heat = dialog.get_by_role("img", name=re.compile("^Temperature: .* to 180.0"))
    expect(heat).to_be_visible()
    assert barriers(page) == []

    read_at(dialog, 175 / 300)
    for title, value in (
        ("Temperature", "180.0 °C"),
        ("Activity", "Walking"),
        ("Floor", "floor 1"),
    ):
        output = dialog.get_by_role("region", name=title).get_by_role("status")
        expect(output).to_have_text(re.compile(value.replace(" ", r"\s")))

    with page.expect_request(re.compile("/replays/[^/]+$")) as sought:
        dialog.locator(".u-over").first.click()
    at_ms = (sought.value.post_data_json or {})["at_ms"]
    assert at_ms == pytest.approx(START_MS + 150_000, abs=10_000), "the middle of the line"
    expect(bar.get_by_label("Time of the incident")).to_have_value(re.compile(str(at_ms // 10_000)))
    with page.expect_request(re.compile("/timeline")) as asked:
        dialog.get_by_role("button", name="Zoom in").click()
    from_ms, until_ms = span_of(asked.value.url)
    assert until_ms - from_ms == pytest.approx(150_000, abs=5_000)
    expect(dialog.locator(".timeline")).to_have_attribute("aria-busy", "false")
    expect(dialog.locator("canvas")).to_have_count(len(STRIPS))
    over = dialog.locator(".u-over").first.bounding_box()
    assert over is not None
    y = over["y"] + over["height"] / 2
    page.mouse.move(over["x"] + 0.2 * over["width"], y)
    page.mouse.down()
    page.mouse.move(over["x"] + 0.6 * over["width"], y, steps=5)
    with page.expect_request(re.compile("/timeline")) as asked:
        page.mouse.up()
    drawn_from_ms, drawn_until_ms = span_of(asked.value.url)
    assert drawn_from_ms == pytest.approx(from_ms + 0.2 * (until_ms - from_ms), abs=3_000)
    assert drawn_until_ms == pytest.approx(from_ms + 0.6 * (until_ms - from_ms), abs=3_000)
    close(dialog)

    gap = open_timeline(page, "FF-02")
    read_at(gap, 120 / 300)
    temperature = gap.get_by_role("region", name="Temperature").get_by_role("status")
    expect(temperature).to_have_text("not known")
    close(gap)


def test_alarm_shows_its_threshold_and_the_values_around_it(page: Page) -> None:
    paused_replay(page).get_by_label("Time of the incident").press("End")
    card = page.locator("[data-unit='FF-01']")
    expect(card).to_contain_text("No motion")
    press(card.locator(".card-head, .line").first)
    card.get_by_role("button", name=re.compile("^Reasons? of the alarm")).click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("time without motion was")
    expect(dialog).to_contain_text("beyond the threshold “pre alert” (20 s)")
    expect(dialog).to_contain_text("Thresholds at that time: pre alert 20 s, alarm 25 s")
    expect(dialog.locator("canvas")).to_have_count(len(STRIPS))
    assert barriers(page) == []
    close(dialog)
