"""The demo's base station, or two of which one stands by."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from pathlib import Path

import httpx

from deploy.demo.processes import Child, Children
from shared.errors import UserError

_PATIENCE_S = 60.0
_POLL_INTERVAL_S = 0.2
_ANSWER_S = 2.0


@dataclass(frozen=True, slots=True)
class Site:
    """One station's place."""

    name: str
    data: Path  # its process is called like this folder
    bus: str
    address: str


class Stations:
    """``enrol`` first, then ``start``."""

    def __init__(self, children: Children, folder: Path, sites: tuple[Site, ...]) -> None:
        self._children = children
        self._folder = folder
        self.sites = sites
        self._running: dict[str, Child] = {}

    @property
    def data(self) -> Path:
        """Folder of the authority."""
        return self.sites[0].data

    def enrol(self) -> None:
        """Make the authority; a second station gets its certificate in one file."""
        first, *others = self.sites
        host, _, port = first.bus.removeprefix("tls/").rpartition(":")
        data = ("--data", str(first.data))
        self._children.run("pki", ("pki", "init", *data, "--host", host, "--port", port))
        for other in others:
            host, _, port = other.bus.removeprefix("tls/").rpartition(":")
            file = str(self._folder / f"{other.name}.station.toml")
            flags = (*data, "--host", host, "--port", port, "--out", file)
            self._children.run("pki", ("pki", "enroll-station", other.name, *flags))
            self._children.run("pki", ("pki", "join", file, "--data", str(other.data)))

    def start(self) -> tuple[str, str]:
        """Name and password of the first login.  They are noted before the station knows them."""
        is_new = not any(_note(site).exists() for site in self.sites)
        for site in self.sites:
            settings = self._folder / f"{site.name}.toml"
            settings.write_text(self._settings(site), encoding="utf-8")
            self._running[site.name] = self._children.start(
                site.data.name, ("base", "serve", "--config", str(settings))
            )
        for site in self.sites:
            self._children.wait_for_line(self._running[site.name], "ready", _PATIENCE_S)
        leading = self.leading()
        if is_new:
            self._children.wait_for_line(self._running[leading.name], "first login", _PATIENCE_S)
        text = _note(leading).read_text(encoding="utf-8")
        login = dict(line.split(": ", 1) for line in text.splitlines())
        return login["username"], login["password"]

    def note_login(self, username: str, password: str) -> None:
        """For whoever starts the stations on this folder again."""
        for site in self.sites:
            if _note(site).exists():
                _note(site).write_text(f"username: {username}\npassword: {password}\n")

    def leading(self) -> Site:
        """The station that leads; waits for one that takes over.  UserError where none does."""
        end_s = time.monotonic() + _PATIENCE_S
        while time.monotonic() < end_s:
            for site in self.sites:
                if self._running[site.name].exit_code is None and _leads(site):
                    return site
            self._children.wait(_POLL_INTERVAL_S)
        raise UserError(f"no station leads; see {self._folder / 'output'}")

    def alive(self) -> tuple[Site, ...]:
        return tuple(s for s in self.sites if self._running[s.name].exit_code is None)

    def process_id(self, site: Site) -> int:
        return self._running[site.name].process.pid

    def _settings(self, site: Site) -> str:
        settings = (
            f"data = {json.dumps(str(site.data.absolute()))}\n"
            f"[bus]\nlisten = [{json.dumps(site.bus)}]\n"
            f"[http]\nlisten = {json.dumps(site.address.removeprefix('http://'))}\n"
        )
        peers = [other.bus for other in self.sites if other is not site]
        if peers:
            settings += (
                f"[standby]\nname = {json.dumps(site.name)}\npeer = {json.dumps(peers)}\n"
                f"url = {json.dumps(site.address)}\n"
                f"preferred = {json.dumps(site is self.sites[0])}\n"
            )
        return settings


def _note(site: Site) -> Path:
    return site.data / "first-login.txt"


def _leads(site: Site) -> bool:
    try:
        answer = httpx.get(f"{site.address}/api/v1/standby/leads", timeout=_ANSWER_S)
        return bool(answer.json()["leads"])
    except (httpx.HTTPError, ValueError, KeyError):
        return False
