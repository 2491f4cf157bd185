"""A department and whole stations, each in a network of its own, joined by links to be spoiled."""

from __future__ import annotations

import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import msgspec

from base_station.forwarders.department.events import alarm_event
from base_station.security.pki.folder import PkiFolder
from shared.channels import ALARM
from shared.codec import decode
from shared.enrolment import Holder
from shared.mcap_log import read_log
from shared.messages import STATION_ID, AlarmChange
from tests.rig.department_process import DepartmentProcess
from tests.rig.latency import Latency
from tests.rig.lossy_link import LossyLink, Namespace
from tests.rig.pacing import wait_until
from tests.rig.program import Launch
from tests.rig.station_process import StationProcess, station_process

PORT, HTTP_PORT = 7448, 8090
_ALARM_KEY = ALARM.key(STATION_ID)
_UNITS = 3
_MAYDAYS_HZ = 2.0  # each with three transitions


class ReportingStation:
    """``muster base serve`` that reports, with people and an operator in its network."""

    def __init__(
        self, folder: Path, enrolment: Path, link: LossyLink, launch: Launch, *, number: int = 0
    ) -> None:
        """``number``: of the stations in that network."""
        self.link = link
        self._data = folder / "station"
        self._data.mkdir(parents=True)
        self._address = f"tls/127.0.0.1:{7447 + 10 * number}"
        PkiFolder(self._data).create("Engine", hosts=[], connect=[self._address])
        self._settings = folder / "station.toml"
        self._settings.write_text(f'[department]\nenrolment = "{enrolment}"\n')
        self._launch = launch
        self._running = ExitStack()
        self._work: subprocess.Popen[bytes]
        self.process: StationProcess

    def start(self, before: str = "") -> None:
        """Gives back when its people walk.  ``before``: as of ``Launch``."""
        self.process = self._running.enter_context(
            station_process(
                self._data,
                self._address,
                self.link.units,
                launch=self._launch,
                settings=self._settings,
                before=before,
            )
        )
        module = [sys.executable, "-m", "tests.rig.worked_station"]
        arguments = [self.process.url, str(self._data), str(_UNITS), str(_MAYDAYS_HZ)]
        self._work = subprocess.Popen(
            [*self.link.units.inside(), *module, *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        self._running.callback(_end, self._work)
        assert self._work.stdout is not None
        assert self._work.stdout.readline() == b"ready\n"

    def kill(self) -> None:
        self._running.close()

    def latency(self) -> Latency:
        """From sensor to console, of what its units sent since this was asked last."""
        return msgspec.json.decode(self._ask(b"latency\n"), type=Latency)

    def forget_latency(self) -> None:
        """Leave out of ``latency`` what was sent until now, which may be nothing."""
        self._ask(b"latency\n")

    def quieten(self) -> None:
        """It decides nothing more, and hands over what it has."""
        assert self._ask(b"quiet\n") == b"quiet\n"

    def alarm_events(self) -> set[str]:
        """Ids of all that it has decided, by its log."""
        changes = (
            decode(ALARM, payload)
            for _, key, payload in read_log(self._data / "log")
            if key == _ALARM_KEY
        )
        return {alarm_event(one).event_id for one in changes if isinstance(one, AlarmChange)}

    def _ask(self, command: bytes) -> bytes:
        assert self._work.stdin is not None
        assert self._work.stdout is not None
        self._work.stdin.write(command)
        self._work.stdin.flush()
        return self._work.stdout.readline()


class DepartmentNetwork:
    """The department is in one network, and each station behind a link of its own."""

    def __init__(
        self,
        folder: Path,
        closing: ExitStack,
        launch: Launch,
        seed: int,
        settings: Path | None = None,
    ) -> None:
        """``settings``: the department's.  Raises BusError where this machine does not allow it."""
        self._folder, self._closing = folder, closing
        self._launch, self._seed = launch, seed
        self.stations: list[ReportingStation] = []
        self._network = Namespace("10.77.0.1", closing)
        host = self._network.address
        self.address = f"tls/{host}:{PORT}"
        data = folder / "city"
        self.pki = PkiFolder(data)
        self.pki.create("City", hosts=[host], connect=[self.address])
        self.department = DepartmentProcess(
            data, self.address, HTTP_PORT, launch, self._network, settings
        )
        closing.callback(self.department.kill)

    def add_station(self, name: str) -> ReportingStation:
        """One that is counted: what it decides must arrive, once."""
        number = len(self.stations) + 2
        units = Namespace(f"10.77.0.{number}", self._closing)
        link = LossyLink(self._seed + number, self._closing, self._network, units)
        station = self.place_station(name, self.enrol(name, self.pki), link)
        self.stations.append(station)
        return station

    def place_station(
        self, place: str, enrolment: Path, link: LossyLink, *, number: int = 0
    ) -> ReportingStation:
        folder = self._folder / place
        station = ReportingStation(folder, enrolment, link, self._launch, number=number)
        self._closing.callback(station.kill)
        return station

    def enrol(self, name: str, pki: PkiFolder) -> Path:
        """File of a new enrolment, by this authority or another one."""
        path = self._folder / f"{pki.path.parent.name}-{name}.toml"
        pki.enroll(name, Holder.DEPARTMENT_STATION, connect=[self.address]).write(path)
        return path

    def decided(self) -> set[str]:
        """By all stations that are counted."""
        return set().union(*(one.alarm_events() for one in self.stations))

    def recovery_s(self) -> float:
        """Until everything is there that had been decided when this was called."""
        began_s, decided = time.monotonic(), self.decided()
        wait_until(
            "all that was decided is there",
            lambda: decided <= set(self.department.alarm_events()),
        )
        return time.monotonic() - began_s


def _end(process: subprocess.Popen[bytes]) -> None:
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()
    process.kill()
    process.wait()
