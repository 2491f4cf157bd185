"""The largest plan is loaded while people walk, and their state is shown throughout."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path

import msgspec
from websockets.sync.client import connect

from tests.rig.large_plan import large_plan
from tests.rig.served_station import MakePosition, greet, prepare
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.waiting import until

PLAN_BYTES = 11_000_000
LONGEST_AGE_S = 2.0  # on a machine with much else to do; it was 3 to 12


class _Place(msgspec.Struct):
    t_ms: int


class _Shown(msgspec.Struct):
    position: _Place | None = None


class _Reported(msgspec.Struct):
    type: str
    units: list[_Shown] = []


def test_positions_are_shown_while_a_plan_of_11_mb_is_loaded(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    station, plan = serve(), large_plan(PLAN_BYTES)
    over = threading.Event()
    ages_s: list[float] = []
    plans: list[int] = []

    def walk() -> None:
        due_s = time.monotonic()
        while not over.is_set():
            north_m = 50.0 + time.monotonic() % 10.0
            unit.say(
                make_position(header=unit.header_factory.header(), north_m=north_m, east_m=50.0)
            )
            due_s += 0.1
            over.wait(max(0.0, due_s - time.monotonic()))

    with Browser(station.wait_ready(), data) as browser:
        prepare(browser)
        greet(browser, unit, make_position)
        browser.call("PUT", "/site/anchor", json={"lat_deg": 57.7, "lon_deg": 11.9})
        live = f"{browser.address.replace('http', 'ws', 1)}/api/v1/live"
        cookie = {"Cookie": browser.cookie()}

        def look() -> None:
            with connect(live, additional_headers=cookie, max_size=None) as socket:
                while not over.is_set():
                    text = socket.recv(30.0)
                    if len(text) > PLAN_BYTES:
                        plans.append(len(text))
                        continue
                    units, now_s = msgspec.json.decode(text, type=_Reported).units, time.time()
                    places = [one.position for one in units if one.position is not None]
                    ages_s.extend(now_s - place.t_ms / 1000.0 for place in places)

        threads = [threading.Thread(target=walk), threading.Thread(target=look)]
        for thread in threads:
            thread.start()
        try:
            until(lambda: len(ages_s) > 10, "the unit is shown")
            laid = {"content": plan, "headers": {"content-type": "application/geo+json"}}
            assert browser.status("PUT", "/site/plan", timeout=30.0, **laid) == 204
            until(lambda: bool(plans), "the plan is shown")
            shown = len(ages_s)
            until(lambda: len(ages_s) > shown + 10, "the unit is shown on it")
        finally:
            over.set()
            for thread in threads:
                thread.join()
    assert max(ages_s) < LONGEST_AGE_S, sorted(ages_s)[-5:]
