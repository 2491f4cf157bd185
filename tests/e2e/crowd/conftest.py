"""A browser and the two stations; both last for all modules of this package."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from tests.e2e.browser import open_browser
from tests.e2e.crowd.incident import CROWDS, SCREEN, Incident, incident_of

# As in the life of an incident: the plan is replaced behind all that looks at it, and the incident
# is closed last.  Each module passes alone as well.
ORDER = ("tasks_of_a_commander", "rescue", "floors", "people", "orders", "display", "alarms")
LAST = ("set_up", "wire", "station_away", "closing")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Take all modules of this package with one station, then all with the other."""
    folder = Path(__file__).parent
    places = {folder / f"test_{name}.py": n for n, name in enumerate((*ORDER, *LAST))}

    def turn(item: pytest.Item) -> tuple[int, int]:
        assert isinstance(item, pytest.Function)
        return CROWDS.index(item.callspec.params["incident"]), places[item.path]

    ordered = iter(sorted((one for one in items if one.path in places), key=turn))
    items[:] = [next(ordered) if one.path in places else one for one in items]


@pytest.fixture(scope="package")
def chromium() -> Iterator[Browser]:
    yield from open_browser()


@pytest.fixture(scope="package", params=CROWDS)
def incident(
    request: pytest.FixtureRequest, chromium: Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Incident]:
    with incident_of(request.param, chromium, tmp_path_factory.mktemp("crowd")) as shared:
        yield shared


@pytest.fixture(autouse=True)
def usual_screen(incident: Incident) -> None:
    """Close and enlarge: a page that a failed test has left would make all that follow fail."""
    page = incident.page
    while (dialog := page.locator("dialog[open]")).count():
        dialog.first.press("Escape")
    if page.viewport_size != SCREEN:
        page.set_viewport_size(SCREEN)
