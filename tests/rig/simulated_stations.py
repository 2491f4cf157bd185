"""Many stations that report to one department, in one program.

``python -m tests.rig.simulated_stations FOLDER UNITS``: one station for each enrolment in
FOLDER, each over a link of its own; a summary a second and an alarm every ten.  What was sent is
printed at the end as JSON, when there is a receipt for every event.
"""

from __future__ import annotations

import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from threading import Event as ThreadEvent
from threading import Thread

import msgspec

from base_station.department_wire import (
    AlarmEvent,
    IncidentEvent,
    IncidentSummary,
    PersonEvent,
    PersonSummary,
    PlaceSummary,
    Summary,
)
from shared.enrolment import read_enrolment
from tests.rig.department_reporter import DepartmentReporter
from tests.rig.waiting import until

_ALARM_EVERY_S = 10
_OPENED_AT_ONCE = 16
_CLOCK_PERIOD_MS = 10_000_000  # so that it is exact as a position


class StationsReport(msgspec.Struct):
    """Messages of all of them."""

    seconds: float
    summaries: int
    events: int  # alarms


def station_name(number: int) -> str:
    return f"station-{number:03}"


def clock_ms() -> float:
    """UTC within a period of some hours."""
    return float(DepartmentReporter.now_ms() % _CLOCK_PERIOD_MS)


class SimulatedStation:
    def __init__(self, enrolment: Path, units: int, closing: ExitStack) -> None:
        self._reporter = DepartmentReporter(read_enrolment(enrolment))
        closing.callback(self._reporter.close)
        self.name, self._units = self._reporter.name, units
        self.alarms = 0
        self._opened_ms = DepartmentReporter.now_ms()

    @property
    def is_received(self) -> bool:
        return self._reporter.is_received

    def begin(self) -> None:
        """Open an incident and name everybody."""
        incident = IncidentEvent(self._incident_id, "Bench", self._opened_ms, None)
        people = [PersonEvent(f"p{n}", f"Person {n}", "Crew", "") for n in range(self._units)]
        self._reporter.hand_over(incident, *people)

    def publish_summary(self) -> None:
        now_ms = DepartmentReporter.now_ms()
        summary = Summary(
            epoch=1,
            t_ms=now_ms,
            host="bench",
            console_url="",
            incidents=(IncidentSummary(self._incident_id, "Bench", self._opened_ms),),
            people=tuple(self._person(number, now_ms) for number in range(self._units)),
            problems=(),
            waiting=0,
        )
        self._reporter.publish(summary)

    def raise_alarm(self) -> None:
        self.alarms += 1
        now_ms = DepartmentReporter.now_ms()
        alarm_id, unit_id = f"fall|{self.alarms}", f"FF-{self.alarms % self._units:03}"
        self._reporter.hand_over(
            AlarmEvent(alarm_id, "fall", unit_id, 1, "raised", "", "fell", "", now_ms, now_ms)
        )

    @property
    def _incident_id(self) -> str:
        return f"i-{self.name}"

    def _person(self, number: int, now_ms: int) -> PersonSummary:
        # Where somebody is tells when it was sent.
        place = PlaceSummary(now_ms, clock_ms(), 5.0, 1, 52.5, 13.4, 2.5, "good")
        return PersonSummary(
            unit_id=f"FF-{number:03}",
            label=f"Unit {number}",
            person_id=f"p{number}",
            link="live",
            incident_id=self._incident_id,
            place=place,
            activity="walking",
            mayday=False,
            alarms=(),
            par="self",
            par_due_ms=now_ms + 600_000,
        )


def main(folder: Path, units: int) -> None:
    """Until its standard input ends."""
    ended = ThreadEvent()

    def wait_for_end() -> None:
        sys.stdin.read()
        ended.set()

    Thread(target=wait_for_end, daemon=True).start()
    with ExitStack() as closing:
        opening = closing.enter_context(ThreadPoolExecutor(_OPENED_AT_ONCE))
        stations = list(
            opening.map(
                lambda path: SimulatedStation(path, units, closing), sorted(folder.glob("*.toml"))
            )
        )
        until(lambda: all(one.is_received for one in stations), "the department hears all")
        for station in stations:
            station.begin()
        began_s, turn, summaries = time.monotonic(), 0, 0
        while not ended.is_set():
            for number, station in enumerate(stations):
                # Evenly over the second, as stations that do not know of each other.
                due_s = began_s + turn + number / len(stations)
                time.sleep(max(due_s - time.monotonic(), 0.0))
                station.publish_summary()
                summaries += 1
                if (turn + number) % _ALARM_EVERY_S == 0:
                    station.raise_alarm()
            turn += 1
        took_s = time.monotonic() - began_s
        alarms = sum(station.alarms for station in stations)
        print(msgspec.json.encode(StationsReport(took_s, summaries, alarms)).decode(), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
