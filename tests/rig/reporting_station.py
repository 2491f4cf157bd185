"""A station as its department sees it: the reporting part of a station, with people who walk and
alarms that are raised, as a program that can be cut off and killed.

``python -m tests.rig.reporting_station FOLDER ENROLMENT ALARMS_PER_S`` notes each alarm in FOLDER
before it is reported, as a station does in its log, and reads them there after a kill.  It decides
nothing more once there is a file ``quiet``.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable
from pathlib import Path

import msgspec

from base_station.forwarders.department.config import DepartmentConfig
from base_station.forwarders.department.events import alarm_event
from base_station.forwarders.department.forwarder import DepartmentForwarder
from base_station.forwarders.interface import Surroundings
from base_station.storage.db.known_people import person_lookup
from base_station.storage.projection import Projection
from shared.channels import ALARM
from shared.clock import SystemClock
from shared.codec import encode
from shared.messages import STATION_ID, AlarmChange, AlarmState, Header
from tests.rig.tak_scene import Scene, delta

QUIET = "quiet"
_LOG = "alarms.jsonl"
_ALARM_KEY = ALARM.key(STATION_ID)
_UNITS = tuple(f"FF-{number:02}" for number in range(1, 6))


class _Decided(msgspec.Struct):
    """A line of the log."""

    t_ns: int
    alarm_id: str

    def change(self) -> AlarmChange:
        header = Header(STATION_ID, 1, 1, 0, self.t_ns, 0.0)
        state, unit_id = AlarmState.RAISED, _UNITS[self.t_ns % len(_UNITS)]
        return AlarmChange(
            header, self.alarm_id, "fall", unit_id, 1, state, "", "fell", "", self.t_ns, self.t_ns
        )


class ReportedLog:
    """What a station has decided; each alarm is on the disk before it is reported."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / _LOG

    def append(self, alarm_id: str) -> AlarmChange:
        decided = _Decided(time.time_ns(), alarm_id)
        with self._path.open("ab") as file:
            file.write(msgspec.json.encode(decided) + b"\n")
        return decided.change()

    def records(self, since_ns: int = 0) -> Iterable[tuple[int, str, bytes]]:
        for one in self._decided():
            if one.t_ns >= since_ns:
                yield one.t_ns, _ALARM_KEY, encode(one.change())

    def event_ids(self) -> list[str]:
        return [alarm_event(one.change()).event_id for one in self._decided()]

    def _decided(self) -> list[_Decided]:
        try:
            lines = self._path.read_bytes().splitlines(keepends=True)
        except FileNotFoundError:
            return []
        whole = [line for line in lines if line.endswith(b"\n")]  # it may just be written
        return [msgspec.json.decode(line, type=_Decided) for line in whole]


def main(folder: Path, enrolment: Path, alarms_per_s: float) -> None:
    """Until it is killed."""
    log, clock = ReportedLog(folder), SystemClock()
    around = Surroundings(
        clock=clock,
        leads=lambda: True,
        data=folder,
        people=person_lookup({}),
        read_log=log.records,
        note_external=lambda *_: None,
    )
    forwarder = DepartmentForwarder("department", DepartmentConfig(enrolment), around)
    scene = Scene(*_UNITS)
    forwarder.reset(scene.picture())
    forwarder.start()
    print("ready", flush=True)
    began_s, number = time.monotonic(), 0
    while True:
        time.sleep(1.0 / alarms_per_s)
        if (folder / QUIET).exists():
            continue
        number += 1
        change = log.append(f"fall|{began_s}|{number}")
        forwarder.project(Projection(change.header.t_utc_ns, alarms=(change,)))
        forwarder.delta(delta(scene.moved(0.1 * number, 0.1 * number)))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3]))
