"""Two real stations and real units as processes, on one loopback or in two namespaces."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from base_station.bench.rig.journal import said_by
from base_station.bench.rig.station import first_login, free_port
from base_station.bench.rig.waiting import wait_until
from base_station.bench.standby.one_of_two import MessageId, Place, Station
from base_station.pki.folder import PkiFolder
from shared.errors import StoreError


class TwoStations:
    """``first`` leads when both start; units know both.  Everything is ended by ``closing``."""

    def __init__(self, folder: Path, places: Sequence[Place], closing_all: ExitStack) -> None:
        self._folder = folder
        self._closing = closing_all
        self.first, self.second = (
            Station(name, place, folder, free_port(), free_port(), self._login)
            for name, place in zip(("first", "second"), places, strict=True)
        )
        self.units: dict[str, subprocess.Popen[bytes]] = {}
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
        self._pki.enroll(unit_id, connect=(near.bus, far.bus)).write(file)
        agent = "from edge.cli import app; app()"
        flags = ["--enrolment", str(file), "--data", str(self._folder / "units")]
        flags += ["--source", "simulated:search-ground-floor", "--tracker", "none"]
        with (self._folder / f"{unit_id}.txt").open("wb") as said:
            self.units[unit_id] = subprocess.Popen(
                [*near.place.inside(), sys.executable, "-c", agent, "run", *flags],
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
            )
        self._closing.callback(_end, self.units[unit_id])

    def wait_heard(self, station: Station) -> None:
        """And known as ours."""

        def all_heard() -> bool:
            units = station.get("/units")
            heard = {u["unit_id"] for u in units if u["last_heard_ms"] and u["registered"]}
            return heard >= self.units.keys()

        wait_until(f"all units are heard at {station.name}", all_heard)

    def stop_units(self) -> None:
        for process in self.units.values():
            _end(process)

    def both_have(self, said: set[MessageId]) -> bool:
        """Whether these messages are in both logs."""
        return all(said <= one.logged().messages.keys() for one in self.both)

    def said(self) -> set[MessageId]:
        """What the units have ever said, by their journals."""
        units = self._folder / "units"
        return {
            (unit_id, boot_id, seq)
            for unit_id in self.units
            for boot_id, seq in said_by(units / unit_id / "journal.sqlite")
        }

    def _both_ready(self) -> bool:
        return (self.first.data / "first-login.txt").exists() and (
            self.first.leads() and self.second.follows()
        )

    def _login(self) -> tuple[str, str]:
        """The same at both."""
        for station in self.both:
            note = station.data / "first-login.txt"
            if note.exists():
                return first_login(note)
        raise StoreError("no station has made a first login yet")


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


def _end(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()
