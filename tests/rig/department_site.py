"""A department with an authority of its own, in this program, as far as its stations see it."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from base_station.department.intake import ReportIntake
from base_station.department.live_picture import LivePicture
from base_station.forwarders.department.config import DepartmentConfig
from base_station.forwarders.department.forwarder import DepartmentForwarder
from base_station.security.pki.folder import PkiFolder
from base_station.security.router.router import Router, station_endpoint
from base_station.storage.db.department_tables import DepartmentTables
from base_station.storage.db.store import Store
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.clock import SystemClock
from shared.enrolment import Enrolment, Holder
from tests.rig.forwarder_surroundings import surroundings
from tests.rig.station_process import free_port


class DepartmentSite:
    """``open`` and ``close`` it as often as wanted; its folder stays."""

    def __init__(self, folder: Path, closing: ExitStack) -> None:
        self._folder, self._closing = folder, closing
        address = f"tls/127.0.0.1:{free_port()}"
        self._listen = (address,)
        self.pki = PkiFolder(folder)
        self.pki.create("City", hosts=[], connect=[address])
        self._store = closing.enter_context(Store(folder / "station.sqlite"))
        self.tables = DepartmentTables(self._store)
        self._open = closing.enter_context(ExitStack())

    def enrol(self, station: str) -> Enrolment:
        return self.pki.enroll(station, Holder.DEPARTMENT_STATION)

    def open(self) -> None:
        self.picture = LivePicture()
        self.intake = ReportIntake(self.tables, self.picture, SystemClock(), lambda: None)
        router = Router(self._folder, self._listen)
        self._open.callback(router.close)
        self.bus = ZenohBus(station_endpoint(self._folder, self._listen))
        self._open.callback(self.bus.close)
        self.intake.open(self.bus, self._open)

    def close(self) -> None:
        self._open.close()

    def forwarder(self, enrolment: Enrolment, data: Path) -> DepartmentForwarder:
        """Forwarder of a station whose folder is ``data``."""
        data.mkdir(exist_ok=True)
        file = data / "enrolment.toml"
        if not file.exists():
            enrolment.write(file)
        forwarder = DepartmentForwarder(
            "department", DepartmentConfig(file), surroundings(SystemClock(), data=data)
        )
        self._closing.callback(forwarder.close)
        return forwarder

    def bus_of(self, enrolment: Enrolment) -> ZenohBus:
        bus = ZenohBus(UnitEndpoint(enrolment.connect, enrolment.identity))
        self._closing.callback(bus.close)
        return bus
