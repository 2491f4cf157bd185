"""Imported files of an incident: on the plan at their time, and in a list that can be changed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import msgspec
from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import drawn, menu, painted, press
from tests.e2e.played_station import API
from tests.e2e.stage import ANSWERS, PAST, Stage
from tests.rig.imported_files import write_photo

NOW_MS = scenes.NOW_MS
TRACK, PHOTO = "a" * 32, "b" * 32


def listed(import_id: str, file_name: str, kind: str) -> dict[str, object]:
    return {
        "import_id": import_id, "file_name": file_name, "format": kind, "sha256": import_id * 2,
        "size_bytes": 2_000, "shift_s": 0.0, "from_ms": NOW_MS - 90_000, "until_ms": NOW_MS,
        "t_ms": NOW_MS, "by": "chief", "is_here": True, "tracks": 1, "names": ["Drone"],
        "warnings": ["2 points without a place or a time are left out"],
    }  # fmt: skip


def tracks(
    import_id: str, name: str, points: Sequence[Sequence[object]], url: str | None
) -> object:
    return {
        "import_id": import_id, "format": "", "file_name": name, "picture_url": url,
        "tracks": [{"name": name, "points": points}],
    }  # fmt: skip


def answers() -> dict[str, object]:
    imports = f"{PAST}/imports"
    walk = [
        [NOW_MS + 1_000 * (second - 90), 2.0 + 0.1 * second, 5.0 + 0.1 * second, None]
        for second in range(200)  # the last of them are still to come
    ]
    picture = f"{API}{imports}/{PHOTO}/picture"
    return {
        **ANSWERS,
        imports: [listed(TRACK, "drone.gpx", "gpx"), listed(PHOTO, "door.jpg", "photo")],
        f"{imports}/{TRACK}/tracks": tracks(TRACK, "Drone", walk, None),
        f"{imports}/{PHOTO}/tracks": tracks(
            PHOTO, "door.jpg", [[NOW_MS - 60_000, 12.0, 20.0, None]], picture
        ),
    }


def test_a_track_and_a_photograph_are_on_the_plan_of_a_replay(stage: Stage, tmp_path: Path) -> None:
    photo = write_photo(tmp_path / "door.jpg", None).read_bytes()
    page, station = stage.open(
        msgspec.structs.replace(scenes.past(), units=(), alarms=()), answers=answers()
    )
    page.route("**/picture", lambda route: route.fulfill(body=photo, content_type="image/jpeg"))
    page.reload()
    page.get_by_role("button", name="Trails").click()
    shown = page.get_by_label("Brought in (2)")
    expect(shown).to_be_checked()
    drawn(page)
    page.wait_for_timeout(500)
    with_both = painted(page, "--text")
    shown.uncheck()
    page.wait_for_timeout(300)
    without = painted(page, "--text")
    assert with_both > without + 150, "a dashed way, a square, a pin and two names"
    shown.check()
    replay = station.picture.replay
    assert replay is not None
    earlier_ms = NOW_MS - 120_000  # before both
    station.change(now_ms=earlier_ms)
    page.wait_for_timeout(1500)
    assert painted(page, "--text") < without + 50, "nothing of the time to come"


def test_files_are_imported_and_removed_in_the_list(stage: Stage, tmp_path: Path) -> None:
    page, station = stage.open(scenes.quiet(), answers=answers())
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name=f"Brought in: {scenes.INCIDENT.name}").click()
    listing = page.get_by_role("dialog", name=f"Brought into {scenes.INCIDENT.name}")
    expect(listing.get_by_role("link", name="drone.gpx")).to_be_visible()
    expect(listing).to_contain_text("2 points without a place or a time are left out")
    file = tmp_path / "car.gpx"
    file.write_text("<gpx/>")
    listing.get_by_label("Files (GPX, KML, photograph, MCAP)").set_input_files([file])
    listing.get_by_label("Seconds to add, clock was off").fill("-7.5")
    with page.expect_request(lambda request: request.method == "POST") as sent:
        listing.get_by_role("button", name="Bring in", exact=True).click()
    assert sent.value.url.endswith("/imports?file_name=car.gpx&shift_s=-7.5")
    assert sent.value.post_data == "<gpx/>"
    expect(listing.get_by_text("It is in.")).to_be_visible()
    listing.get_by_role("button", name="Take out: door.jpg").click()
    press(listing.get_by_role("button", name="Yes, take it out"))
    station.expect_changes(f"{PAST}/imports", f"{PAST}/imports/{PHOTO}")
    listing.get_by_role("button", name="Incidents").click()
    expect(page.get_by_role("dialog", name="Incidents")).to_be_visible()
