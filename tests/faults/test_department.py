"""A department and its stations in networks of their own: cut off, killed, refused.

Nothing is lost and nothing comes twice; what was sent and how long it took is printed.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

import pytest

from base_station.security.pki.folder import PkiFolder
from shared.enrolment import Holder
from tests.rig.department_process import DepartmentProcess
from tests.rig.link_forwarder import Conditions
from tests.rig.loaded_program import launch_loaded
from tests.rig.lossy_link import CLEAN, DARK, LossyLink
from tests.rig.reporting_station import QUIET, ReportedLog
from tests.rig.waiting import until

SEED = 33
CUT_S = 6.0
ALARMS_PER_S = 10.0
LOSSY = Conditions(loss=0.2, delay_s=0.015)
PORT, HTTP_PORT = 7448, 8090

pytestmark = pytest.mark.usefixtures("links")


class Roof:
    """A department at one end of a link, and stations at the other."""

    def __init__(self, folder: Path, closing: ExitStack) -> None:
        self.link = LossyLink(SEED, closing)
        self._folder, self._closing = folder, closing
        self.address = f"tls/{self.link.station.address}:{PORT}"
        data = folder / "city"
        self.pki = PkiFolder(data)
        self.pki.create("City", hosts=[self.link.station.address], connect=[self.address])
        self.department = DepartmentProcess(
            data, self.address, HTTP_PORT, launch_loaded, self.link.station
        )
        closing.callback(self.department.kill)

    def station(self, name: str, pki: PkiFolder) -> ReportingProcess:
        folder = self._folder / f"{pki.path.parent.name}-{name}"
        folder.mkdir()
        enrolment = folder / "enrolment.toml"
        made = pki.enroll(name, Holder.DEPARTMENT_STATION, connect=[self.address])
        made.write(enrolment)
        station = ReportingProcess(folder, enrolment, self.link)
        self._closing.callback(station.kill)
        return station

    def recovery_s(self, stations: Sequence[ReportingProcess]) -> float:
        """Until everything is there that had been decided when this was called."""
        began_s = time.monotonic()
        decided = {one for station in stations for one in station.log.event_ids()}
        until(lambda: decided <= set(self.department.alarm_events()), "all that was decided")
        return time.monotonic() - began_s


class ReportingProcess:
    def __init__(self, folder: Path, enrolment: Path, link: LossyLink) -> None:
        self.log = ReportedLog(folder)
        self._folder = folder
        module = [sys.executable, "-m", "tests.rig.reporting_station"]
        arguments = [str(folder), str(enrolment), str(ALARMS_PER_S)]
        self._command = [*link.units.inside(), *module, *arguments]
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        self._process = subprocess.Popen(self._command, stdout=subprocess.PIPE)
        assert self._process.stdout is not None
        assert self._process.stdout.readline() == b"ready\n"

    def quieten(self) -> None:
        """It decides nothing more, and hands over what it has."""
        (self._folder / QUIET).touch()

    def kill(self) -> None:
        if self._process is not None:
            assert self._process.stdout is not None
            self._process.stdout.close()
            self._process.kill()
            self._process.wait()


def test_stations_that_are_cut_off_and_kills_of_both_sides_lose_nothing_and_repeat_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with ExitStack() as closing:
        roof = Roof(tmp_path, closing)
        stations = [roof.station(name, roof.pki) for name in ("engine-7", "engine-8")]
        for station in stations:
            station.start()
        time.sleep(CUT_S)  # they work before there is a department
        roof.department.start()
        took_s = {"first start of the department": roof.recovery_s(stations)}

        roof.link.set(LOSSY)
        time.sleep(CUT_S)
        took_s["20 % of packets lost each way"] = roof.recovery_s(stations)

        roof.link.set(DARK)
        time.sleep(CUT_S)
        roof.link.set(CLEAN)
        took_s["link cut"] = roof.recovery_s(stations)

        roof.department.kill()
        time.sleep(CUT_S)
        roof.department.start()
        took_s["department killed"] = roof.recovery_s(stations)

        stations[0].kill()
        time.sleep(1.0)
        stations[0].start()
        took_s["station killed"] = roof.recovery_s(stations)

        other = PkiFolder(tmp_path / "county")
        other.create("County", hosts=[], connect=[roof.address])
        stranger = roof.station("engine-7", other)
        stranger.start()
        time.sleep(CUT_S)  # it tries once a second
        for station in (*stations, stranger):
            station.quieten()
        time.sleep(1.0)  # what they were about to decide
        roof.recovery_s(stations)
        sent = {one for station in stations for one in station.log.event_ids()}
        foreign = set(stranger.log.event_ids())
        arrived = roof.department.alarm_events()
        view = roof.department.get("/department")
    with capsys.disabled():
        print(f"\nsent {len(sent)}, arrived {len(arrived)}, recovery in s: {took_s}")
    assert set(arrived) == sent  # none lost, and none of a stranger
    assert len(arrived) == len(sent)  # none twice
    assert foreign
    assert [one["missing"] for one in view["stations"]] == [0, 0]
    assert [one["state"] for one in view["stations"]] == ["live", "live"]
