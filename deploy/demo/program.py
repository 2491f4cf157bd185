"""``muster demo``: one base station and five responders on this machine."""

from __future__ import annotations

import signal
import socket
import time
from collections.abc import Sequence
from datetime import UTC, datetime
from enum import Enum
from pathlib import Path
from threading import Event
from typing import Annotated

import typer
from rich.console import Console

from deploy.demo.console_client import ConsoleClient
from deploy.demo.crew import Crew, read_crew
from deploy.demo.processes import Child, Children, EndRequestedError
from deploy.demo.stations import Site, Stations
from deploy.demo.wearers import HELP, Wearers
from shared.end_signals import end_requested
from shared.errors import UserError
from shared.options import finite

_WATCH_EVERY_S = 0.5
_ROLL_CALL_AT_S = 55.0  # the commander asks once, when somebody is down already
_ARRIVAL_S = 120.0  # for the first message of every unit
_ENGINE = -29.4, -9.6  # north and east of the plan's origin: where crew.toml has them begin
_USUAL_HTTP_PORT = 8080
_USUAL_BUS_PORT = 7447


def demo(
    for_s: Annotated[
        float | None,
        typer.Option(
            "--for",
            help="End so many seconds after the first message of every unit.",
            min=1.0,
            callback=finite,
        ),
    ] = None,
    headless: Annotated[
        bool, typer.Option(help="For scripts: no moving status line, a summary at the end.")
    ] = False,
    recording: Annotated[
        Path | None, typer.Option(help="A recorded walk: the fifth responder plays it.")
    ] = None,
    data: Annotated[
        Path | None, typer.Option(help="Folder for everything the demo writes.")
    ] = None,
    http_port: Annotated[int | None, typer.Option(help="Port of the console.")] = None,
    bus_port: Annotated[int | None, typer.Option(help="Port of the bus.")] = None,
    standby: Annotated[
        bool, typer.Option("--standby", help="A second station, which takes over from the first.")
    ] = False,
    panel: Annotated[
        bool,
        typer.Option("--panel", help="Show what each wearer sees and hears; press their buttons."),
    ] = False,
) -> None:
    """Run a base station and five responders on this machine until Ctrl-C."""
    stop = end_requested()
    folder = data or Path("muster-data") / f"demo-{datetime.now(UTC):%Y%m%d-%H%M%S}"
    address = f"http://127.0.0.1:{http_port or _free_port(_USUAL_HTTP_PORT)}"
    bus = f"tls/127.0.0.1:{bus_port or _free_port(_USUAL_BUS_PORT)}"
    crew = read_crew(recording)
    sites = [Site("first", folder / "station", bus, address)]
    if standby:
        other = f"http://127.0.0.1:{_free_port(0)}"
        sites.append(Site("second", folder / "standby", f"tls/127.0.0.1:{_free_port(0)}", other))
    output = folder / "output"
    with Children(output, stop) as children, Wearers(crew.responder, output) as wearers:
        show = Show.NOTHING if headless else Show.PANELS if panel else Show.STATUS
        stations = Stations(children, folder, tuple(sites))
        try:
            _Demo(children, folder, stations, crew, wearers, show).run(stop, for_s)
        except EndRequestedError:
            typer.echo("Ended before it had begun.")
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)  # all has ended; one press more is no failure


class Show(Enum):
    """Content of the terminal while the demo runs."""

    NOTHING = "nothing"
    STATUS = "a line that is written over"
    PANELS = "what the wearers' panels show"


class _Demo:
    """One run of the demo."""

    def __init__(
        self,
        children: Children,
        folder: Path,
        stations: Stations,
        crew: Crew,
        wearers: Wearers,
        show: Show,
    ) -> None:
        self._children = children
        self._folder = folder
        self._stations = stations
        self._crew = crew
        self._wearers = wearers
        self._show = show
        self._screen = Console(highlight=False, soft_wrap=True)
        self._mourned: list[Child] = []
        self._roll_called = False
        self._evacuated: set[str] = set()
        self._complete_s: float | None = None

    def run(self, stop: Event, for_s: float | None) -> None:
        enrolments = self._enrol_units()
        self._screen.print("Starting the base station ...")
        username, password = self._stations.start()
        site = self._stations.leading()
        with ConsoleClient(site.address, username, password) as console:
            self._stations.note_login(username, console.password)
            plan = self._children.run("plan", ("edge", "plan"))
            incident = console.prepare(self._crew, plan, f"Demo {datetime.now(UTC):%H:%M} UTC")
            self._start_agents(console, enrolments)
            self._screen.print(
                f"\n  console   [bold]{site.address}[/]\n"
                f"  login     [bold]{username}[/]  password  [bold]{console.password}[/]\n"
                f"  data      {self._folder}\n"
            )
            self._announce_standby()
            if self._show is Show.PANELS:
                self._screen.print(HELP)
                self._wearers.listen(self._screen.print)
            self._screen.print("Ctrl-C ends everything." if for_s is None else "")
            self._watch(console, stop, for_s)
            received = self._summarise(console)
            console.close_incident(incident)
            log = self._stations.leading().data
        self._screen.print(f"To replay it: ./muster base replay {incident} --data {log}")
        missing = self._missing(received)
        if missing and not stop.is_set():
            raise UserError(f"no message from: {', '.join(missing)}; see {self._folder / 'output'}")

    def _enrol_units(self) -> list[Path]:
        """Make the station's authority and, for each unit, the file that is carried to it."""
        self._screen.print("Enrolling the units ...")
        self._stations.enrol()
        data = ("--data", str(self._stations.data))
        enrolments = []
        for responder in self._crew.responder:
            enrolments.append(self._folder / f"{responder.unit}.enrolment.toml")
            flags = (*data, "--out", str(enrolments[-1]))
            self._children.run(f"enrol-{responder.unit}", ("pki", "enroll", responder.unit, *flags))
        return enrolments

    def _announce_standby(self) -> None:
        first, *others = self._stations.sites
        for other in others:
            self._screen.print(
                f"  standby   [bold]{other.address}[/], the same login\n\n"
                f"`kill -9 {self._stations.process_id(first)}` to see it take over."
            )

    def _start_agents(self, console: ConsoleClient, enrolments: Sequence[Path]) -> None:
        data = str(self._folder / "units")
        arriving = [one.unit for one in self._crew.responder if "from=" in one.source]
        console.start_at_engine(arriving, *_ENGINE)
        for responder, enrolment in zip(self._crew.responder, enrolments, strict=True):
            unit = responder.unit
            if responder.source.startswith("recording:"):
                console.start_unit_at(unit, north_m=-6.0, east_m=4.0)
            flags = ("--enrolment", str(enrolment), *responder.source_flags, "--data", data)
            self._children.start(unit, ("edge", "run", *flags, *self._wearers.flags(unit)))

    def _watch(self, console: ConsoleClient, stop: Event, for_s: float | None) -> None:
        """Wait for the end, saying how things stand; UserError when the station dies."""
        started_s = time.monotonic()
        while not stop.wait(_WATCH_EVERY_S):
            elapsed_s = time.monotonic() - started_s
            complete_s = _ARRIVAL_S if self._complete_s is None else self._complete_s
            if for_s is not None and elapsed_s >= complete_s + for_s:
                break
            self._run_once(console, elapsed_s)
        self._screen.print()

    def _run_once(self, console: ConsoleClient, elapsed_s: float) -> None:
        for child in self._unmourned():
            self._mourned.append(child)
            self._mourn(child, console)
        for line in self._wearers.step(elapsed_s):
            if self._show is Show.PANELS:
                self._screen.print(line, markup=False)
        try:
            if self._complete_s is None and not self._missing(console.units_received()):
                self._complete_s = elapsed_s
            if elapsed_s >= _ROLL_CALL_AT_S and not self._roll_called:
                console.call_roll()
                self._roll_called = True
            self._evacuate(console, elapsed_s)
            if self._show is Show.STATUS and self._screen.is_terminal:
                self._screen.print(self._status_line(console, elapsed_s), end="\r")
        except UserError:
            time.sleep(_WATCH_EVERY_S)
            if not self._unmourned():  # else it died since, and the next look is at another station
                raise

    def _evacuate(self, console: ConsoleClient, elapsed_s: float) -> None:
        for one in self._crew.responder:
            at_s = one.evacuated_at_s
            if at_s is not None and elapsed_s >= at_s and one.unit not in self._evacuated:
                console.evacuate(one.unit)
                self._evacuated.add(one.unit)

    def _unmourned(self) -> list[Child]:
        return [child for child in self._children.dead() if child not in self._mourned]

    def _mourn(self, child: Child, console: ConsoleClient) -> None:
        if child.name in {site.data.name for site in self._stations.sites}:
            if not self._stations.alive():
                raise UserError(f"the base station has ended:\n{child.last_words()}")
            self._screen.print(f"{child.name} has ended ...")
            leading = self._stations.leading()
            console.move_to(leading.address)
            self._screen.print(f"{leading.data.name} leads: [bold]{leading.address}[/]")
        elif child.exit_code == 0:
            self._screen.print(f"{child.name} has come to the end of its walk")
        else:
            self._screen.print(f"{child.name} has ended unasked:\n{child.last_words()}")

    def _missing(self, received: Sequence[str]) -> list[str]:
        return sorted({one.unit for one in self._crew.responder}.difference(received))

    def _status_line(self, console: ConsoleClient, elapsed_s: float) -> str:
        health, alarms = console.health(), console.open_alarms()
        minutes, seconds = divmod(int(elapsed_s), 60)
        return (
            f"{minutes:02}:{seconds:02}  {health['messages']} messages, "
            f"{health['messages_per_s']:.0f}/s, {len(alarms)} open alarms   "
        )

    def _summarise(self, console: ConsoleClient) -> tuple[str, ...]:
        """Print a summary; return the units that were received."""
        health, received = console.health(), console.units_received()
        self._screen.print(
            f"{health['messages']} messages of {len(received)} units, "
            f"{health['undecodable']} of them not understood"
        )
        for alarm in console.open_alarms():
            self._screen.print(f"  {alarm['unit_id'] or 'station'}: {alarm['text']}")
        for problem in health["problems"]:
            self._screen.print(f"  station: {problem}")
        return received


def _free_port(usual: int) -> int:
    """The usual port where it is free, else any."""
    for port in (usual, 0):
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
            return int(probe.getsockname()[1])
    raise UserError("no port is free on the loopback")
