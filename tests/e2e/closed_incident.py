"""Console of a real station that starts on the log of a closed incident."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, Page

from base_station.app import folder_commands
from tests.e2e.conftest import log_in
from tests.e2e.station_process import StationProcess
from tests.rig.reported_incident import write_log
from tests.rig.station_script import Record


@contextmanager
def station_after_incident(folder: Path, records: list[Record]) -> Iterator[StationProcess]:
    """A station whose log has these records, and whose tables were made from it."""
    data = folder / "station"
    write_log(data, records)
    folder_commands.rebuild(data, lambda _: None)
    station = StationProcess(data)
    station.start()
    yield station
    station.stop()


@contextmanager
def logged_in_page(chromium: Browser, station: StationProcess) -> Iterator[Page]:
    """A page high enough for the dialogs on past incidents."""
    page = chromium.new_page(viewport={"width": 1280, "height": 1000}, reduced_motion="reduce")
    log_in(page, station)
    yield page
    page.close()
