"""People and an operator of one station, as a program in its network: units walk, one after the
other presses MAYDAY, and the operator acknowledges and resolves it.

``python -m tests.rig.worked_station URL DATA UNITS MAYDAYS_HZ``.  It takes commands as lines:
``latency`` prints the delay from sensor to console of what was sent since, as JSON; after ``quiet``
nobody presses any more, which it confirms.  It ends with its input.
"""

from __future__ import annotations

import sys
import time
from contextlib import ExitStack, suppress
from itertools import cycle
from pathlib import Path
from threading import Event, Thread
from urllib.error import HTTPError

import msgspec

from base_station.security.pki.folder import PkiFolder
from shared.bus_zenoh import UnitEndpoint
from shared.enrolment import read_enrolment
from tests.rig.console_client import Api, Console
from tests.rig.first_login import first_login
from tests.rig.latency import Latency, latencies_ms, latency_of
from tests.rig.simulated_units import BenchUnit
from tests.rig.waiting import until

_MESSAGES_HZ = 7.0  # of a unit: five of them are positions
_OPEN = ("raised", "acknowledged")


class Operator:
    """Puts names to the units, and answers what they raise."""

    def __init__(self, api: Api, units: list[BenchUnit]) -> None:
        self._api, self._units = api, units

    def prepare(self) -> None:
        """Prepares a station; the existing data of a restarted one is kept."""
        api = self._api
        if api.get("/units"):
            return
        for unit in self._units:
            api.post("/units", {"unit_id": unit.unit_id})
            person = api.post("/people", {"name": f"Person {unit.unit_id}", "crew": "A"})
            worn = {"unit_id": unit.unit_id, "person_id": person["person_id"]}
            api.post("/assignments", worn)
        api.post("/incidents", {"name": "Bench"})

    def answer(self) -> None:
        """Answers alarms; one raised again meanwhile is refused, and answered the next time."""
        for alarm in self._api.get("/alarms?limit=20"):
            if alarm["rule"] == "mayday" and alarm["state"] in _OPEN:
                path = f"/alarms/{alarm['alarm_id']}"
                seen = {"last_raised_ms": alarm["last_raised_ms"]}
                with suppress(HTTPError):
                    self._api.post(f"{path}/acknowledge", seen)
                    self._api.post(f"{path}/resolve", seen)


class Work:
    def __init__(self, url: str, data: Path, count: int, closing: ExitStack) -> None:
        names = [f"FF-{number:02}" for number in range(1, count + 1)]
        self._units = [_unit(data, name, closing) for name in names]
        api = Api(url, *first_login(url, data / "first-login.txt"))
        self.operator = Operator(api, self._units)
        self.operator.prepare()
        self._console = Console(api, closing)
        self._is_quiet, self._rests, self._ends = Event(), Event(), Event()
        self._threads: list[Thread] = []

    def start(self, maydays_hz: float) -> None:
        until(lambda: all(unit.is_received for unit in self._units), "the station listens")
        for unit in self._units:
            unit.introduce()
        for work, rate_hz in ((self._walk, _MESSAGES_HZ), (self._press, maydays_hz)):
            Thread(target=work, args=(1.0 / rate_hz,), daemon=True).start()

    def quieten(self) -> None:
        """Nothing more is decided when this returns."""
        self._is_quiet.set()
        self._rests.wait()

    def latency(self) -> Latency:
        """Latency of the messages since the last call."""
        sent = {unit.unit_id: tuple(unit.sent.position_times_ns) for unit in self._units}
        for unit in self._units:
            del unit.sent.position_times_ns[: len(sent[unit.unit_id])]
        shown = {name: dict(self._console.shown.get(name, {})) for name in sent}
        return latency_of(latencies_ms(sent, shown))

    def _walk(self, period_s: float) -> None:
        while True:
            time.sleep(period_s)
            for unit in self._units:
                unit.speak()

    def _press(self, period_s: float) -> None:
        for unit in cycle(self._units):
            if self._is_quiet.is_set():
                break
            unit.press_mayday()
            time.sleep(period_s)
            self.operator.answer()
        self._rests.set()


def _unit(data: Path, name: str, closing: ExitStack) -> BenchUnit:
    file = data.with_name(f"{name}.toml")
    if not file.exists():
        PkiFolder(data).enroll(name).write(file)
    enrolment = read_enrolment(file)
    return BenchUnit(name, UnitEndpoint(enrolment.connect, enrolment.identity), closing)


def main(url: str, data: Path, units: int, maydays_hz: float) -> None:
    with ExitStack() as closing:
        work = Work(url, data, units, closing)
        work.start(maydays_hz)
        print("ready", flush=True)
        for line in sys.stdin:
            if line.strip() == "quiet":
                work.quieten()
                print("quiet", flush=True)
            else:
                print(msgspec.json.encode(work.latency()).decode(), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4]))
