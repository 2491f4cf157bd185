"""Two real stations and real units as processes, on one loopback or in two namespaces."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from base_station.security.pki.folder import PkiFolder
from shared.enrolment import Enrolment
from shared.errors import StoreError
from tests.bench.standby.station_of_pair import MessageId, Place, Station
from tests.rig.first_login import first_login
from tests.rig.pacing import wait_until
from tests.rig.program import Launch, Program, end_hard, launch_installed
from tests.rig.station_process import free_port
from tests.rig.unit_journal import stated_by


class TwoStations:
    """``first`` leads when both start; units know both.  Everything is ended by ``closing``."""

    def __init__(
        self,
        folder: Path,
        places: Sequence[Place],
        closing_all: ExitStack,
        launch: Launch = launch_installed,
    ) -> None:
        self._folder = folder
        self._launch = launch
        self._closing = closing_all
        self.first, self.second = (
            Station(name, place, folder, free_port(), free_port(), self._login, launch)
            for name, place in zip(("first", "second"), places, strict=True)
        )
        self.units: dict[str, Program] = {}
        self._credentials: tuple[str, str] | None = None
        self._pki = PkiFolder(self.first.data)
        self._pki.create("bench", [self.first.place.address], [self.first.bus])
        joining = self._pki.enroll_station("second", [self.second.place.address], self.second.bus)
        PkiFolder(self.second.data).join(joining)
        for one, other in ((self.first, self.second), (self.second, self.first)):
            _write_settings(folder / f"{one.name}.toml", one, other, preferred=one is self.first)
            closing_all.callback(one.kill)

    def start(self) -> None:
        """Both, and wait until the second has what the first has."""
        for one in self.both:
            one.start()
        wait_until("the first leads and the second follows", self._both_ready)

    @property
    def both(self) -> tuple[Station, Station]:
        return self.first, self.second

    def leader(self) -> Station | None:
        """The one that leads and that the other follows; None: it is not so far."""
        for one, other in (self.both, self.both[::-1]):
            if one.leads() and other.follows():
                return one
        return None

    def start_unit(self, unit_id: str, near: Station) -> None:
        """A unit that prefers the router of one station; it sends raw samples, several a second."""
        far = self.second if near is self.first else self.first
        file = self._folder / f"{unit_id}.toml"
        self.enroll(unit_id, near, far).write(file)
        flags = ["--enrolment", str(file), "--data", str(self._folder / "units")]
        flags += ["--source", "simulated:search-ground-floor", "--tracker", "none"]
        output = self._folder / f"{unit_id}.txt"
        unit = self._launch("edge", ("run", *flags), output, near.place.namespace)
        self.units[unit_id] = unit
        self._closing.callback(end_hard, unit)

    def enroll(self, unit_id: str, *stations: Station) -> Enrolment:
        """With the addresses of these stations."""
        return self._pki.enroll(unit_id, connect=[one.bus for one in stations])

    def wait_received(self, station: Station) -> None:
        """And known as ours."""

        def all_received() -> bool:
            units = station.get("/units")
            received = {u["unit_id"] for u in units if u["last_heard_ms"] and u["registered"]}
            return received >= self.units.keys()

        wait_until(f"all units are heard at {station.name}", all_received)

    def stop_units(self) -> None:
        for unit in self.units.values():
            end_hard(unit)

    def both_have(self, reported: set[MessageId]) -> bool:
        """True if these messages are in both logs."""
        return all(reported <= one.logged().messages.keys() for one in self.both)

    def output(self) -> set[MessageId]:
        """All messages of the units, by their journals."""
        units = self._folder / "units"
        return {
            (unit_id, boot_id, seq)
            for unit_id in self.units
            for boot_id, seq in stated_by(units / unit_id / "journal.sqlite")
        }

    def _both_ready(self) -> bool:
        return (self.first.data / "first-login.txt").exists() and (
            self.first.leads() and self.second.follows()
        )

    def _login(self) -> tuple[str, str]:
        """The same at both; changed, once, at the station that made it."""
        if self._credentials is None:
            made_it = [one for one in self.both if (one.data / "first-login.txt").exists()]
            if not made_it:
                raise StoreError("no station has made a first login yet")
            station = made_it[0]
            self._credentials = station.place.call(
                lambda: first_login(station.url, station.data / "first-login.txt")
            )
        return self._credentials


def _write_settings(path: Path, one: Station, other: Station, *, preferred: bool) -> None:
    text = f"""
data = {json.dumps(str(one.data))}
insecure = true  # the console, in a network that nobody else is in
[bus]
listen = [{json.dumps(one.bus)}]
[http]
listen = "{one.place.address}:{one.http_port}"
[standby]
name = "{one.name}"
peer = [{json.dumps(other.bus)}]
url = "{one.url}"
preferred = {json.dumps(preferred)}
"""
    path.write_text(text, encoding="utf-8")
