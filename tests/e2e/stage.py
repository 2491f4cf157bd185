"""The console on a screen of any size, with a station that is played."""

from __future__ import annotations

from collections.abc import Mapping

from playwright.sync_api import Browser, Page

from base_station.views.wire import Snapshot
from tests.e2e import scenes
from tests.e2e.played_station import Answers, PlayedStation, answers

SCREENS = {
    "laptop": (1280, 800),
    "large": (1920, 1080),
    "tablet": (1024, 768),
    "tablet upright": (768, 1024),
    "phone": (390, 844),
    "phone on its side": (844, 390),
    "large at 200 %": (960, 540),
    "laptop at 200 %": (683, 384),
}
PAST = f"/incidents/{scenes.INCIDENT.incident_id}"
ANSWERS = answers(
    "administrator",
    {
        "/incidents": scenes.INCIDENTS,
        PAST: scenes.INCIDENTS[0],
        f"{PAST}/alarms": scenes.PAST_ALARMS,
        "/replays": [scenes.replay("r1", begun_by="")],
        "POST /people": scenes.PEOPLE[0],
        "POST /replays": scenes.replay("r2", begun_by="chief"),
    },
    people=scenes.PEOPLE,
)


class Stage:
    """Opens the console on a picture."""

    def __init__(self, browser: Browser) -> None:
        self._browser = browser
        self._pages: list[Page] = []

    def open(
        self,
        picture: Snapshot,
        screen: str = "laptop",
        answers: Answers = ANSWERS,
        timezone: str | None = None,
        locale: str | None = None,
        kept: Mapping[str, str] | None = None,
    ) -> tuple[Page, PlayedStation]:
        """`locale` is the browser's; `kept` are choices that it has kept, by name."""
        width, height = SCREENS[screen]
        page = self._browser.new_page(
            viewport={"width": width, "height": height}, timezone_id=timezone, locale=locale
        )
        for name, choice in (kept or {}).items():
            page.add_init_script(f"localStorage.setItem({name!r}, {choice!r})")
        self._pages.append(page)
        station = PlayedStation(page, picture, answers)
        station.open()
        page.get_by_role("heading", level=1).wait_for()
        return page, station

    def close(self) -> None:
        for page in self._pages:
            page.close()
