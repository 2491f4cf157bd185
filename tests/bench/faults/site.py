"""A station and its units as processes in networks of their own, to be troubled and measured."""

from __future__ import annotations

import random
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

import psutil

from base_station.core.events import MessageNumber, number_in
from shared.channels import ALARM, Direction, Qos, is_backfilled, parse_key
from shared.codec import decode, header_of
from shared.errors import BusError, UnknownChannelError
from shared.mcap_log import read_log, segment_paths
from shared.messages import STATION_ID, AlarmChange
from tests.bench.faults.attacker import FORGED_BOOT
from tests.bench.faults.bus_identities import GONE, LATE, MEMBERS, UNIT, Members
from tests.rig.connection_flood import connection_flood
from tests.rig.lossy_link import LossyLink
from tests.rig.program import Launch, Program, end_hard, launch_installed
from tests.rig.station_process import StationProcess, station_process
from tests.rig.unit_journal import MessageOfUnit, stated_by

START_PATIENCE_S = 200.0  # the first agent on a machine compiles its tracker
_PORT = 7447
_FLIPPED = 3  # bits of each segment
_HEAD_BYTES = 1000  # of a segment: what kind of file it is, for one
_TORN_BYTES = 500
_POLL_INTERVAL_S = 0.5
_STOP_S = 30.0
# The machine's clock is set by a day while the agent runs.
_AGENT_OF_JUMPS = """
import time
began_s, utc_ns = time.monotonic(), time.time_ns
time.time_ns = lambda: utc_ns() + (86_400 * 10**9 * {days} if time.monotonic() - began_s > {after_s} else 0)
""".strip()  # noqa: E501


class Logged(NamedTuple):
    """A message of the unit in the station's log."""

    message: MessageOfUnit
    t_ns: int  # when the station wrote it
    sent_ns: int
    live: bool
    alert: bool


class Agent:
    """``muster edge run`` of the unit, or of another machine under its name."""

    def __init__(self, link: LossyLink, folder: Path, enrolment: str, launch: Launch) -> None:
        self.journal = folder / UNIT / "journal.sqlite"
        self._stated = folder.with_suffix(".txt")
        arguments = ["run", "--enrolment", enrolment, "--data", str(folder)]
        self._arguments = [*arguments, "--source", "simulated:search-ground-floor"]
        self._network = link.units
        self._launch = launch
        self._program: Program | None = None

    def start(self, before: str = "") -> None:
        """``before``: what Python is to do first."""
        self._program = self._launch("edge", self._arguments, self._stated, self._network, before)

    def start_with_jumping_clock(self, days: int, after_s: float) -> None:
        self.start(_AGENT_OF_JUMPS.format(days=days, after_s=after_s))

    def kill(self) -> None:
        if self._program is not None:
            end_hard(self._program)
            self._program = None

    def stop(self) -> None:
        """In order: what it has said is out when it ends."""
        assert self._program is not None
        self._program.send_signal(signal.SIGTERM)
        self._program.wait(_STOP_S)

    def set_disk_full(self, *, full: bool) -> None:
        assert self._program is not None
        _set_disk_full(self._program.pid, full=full)

    def output(self) -> set[MessageOfUnit]:
        """All that it has ever said, by its journal."""
        return stated_by(self.journal)


class Site:
    """A station and a unit that are at it already."""

    def __init__(
        self,
        folder: Path,
        link: LossyLink,
        members: Members,
        address: str,
        stack: ExitStack,
        launch: Launch,
    ) -> None:
        self.link = link
        self._launch = launch
        self.members = members
        self.agent = Agent(link, folder / "units", members.unit, launch)
        self.clone = Agent(link, folder / "clone", members.unit, launch)
        for agent in (self.agent, self.clone):
            stack.callback(agent.kill)
        self._data = folder / "station"
        self._address = address
        self._running = stack.enter_context(ExitStack())
        self.station: StationProcess
        self.start_station()

    def start_station(self) -> None:
        network = self.link.station
        self.station = self._running.enter_context(
            station_process(self._data, self._address, network, launch=self._launch)
        )

    def kill_station(self) -> None:
        self._running.close()

    @contextmanager
    def suspended_station(self) -> Iterator[None]:
        """With its router, as where the machine lets nobody run; the network goes on."""
        station = psutil.Process(self.station.pid)
        stopped = [station, *station.children()]
        for one in stopped:
            one.suspend()
        try:
            yield
        finally:
            for one in stopped:
                one.resume()

    def damage_log(self, chance: random.Random) -> None:
        """Damages the log of a stopped station: bits flip, and the end is missing."""
        for path in segment_paths(self._data / "log"):
            content = bytearray(path.read_bytes())
            for _ in range(_FLIPPED):
                content[chance.randrange(_HEAD_BYTES, len(content))] ^= 1 << chance.randrange(8)
            path.write_bytes(content[:-_TORN_BYTES])

    def set_station_disk_full(self, *, full: bool) -> None:
        _set_disk_full(self.station.pid, full=full)

    def ask_par(self) -> None:
        """The wearer answers some seconds later; the answers are alerts."""
        order = {"kind": "par_request", "target": {"unit_id": UNIT}, "expires_s": 900}
        self.link.station.call(lambda: self.station.api.post("/commands", order))

    def meddle(self, what: str, membership: str, names: str, seconds: float) -> None:
        """Somebody else on the bus does what ``meddler`` says, beside the unit."""
        module = [sys.executable, "-m", "tests.bench.faults.attacker", what, membership]
        command = [*self.link.units.inside(), *module, names, str(self._data / "log"), str(seconds)]
        subprocess.run(command, check=True)
        received = {unit_id for unit_id, _, _ in self._numbers()}
        for name in {*names.split(",")} & MEMBERS - received:
            raise BusError(f"{name} who may speak for itself is not heard, so nothing was tried")

    def attack(self, what: str, enrolment: str, seconds: float) -> None:
        """Somebody does what ``flooding_unit`` says, beside the unit."""
        subprocess.run(self._attack(what, enrolment, seconds), check=True)

    @contextmanager
    def attacked(self, what: str, enrolment: str, seconds: float) -> Iterator[None]:
        """As ``attack``, while something else happens; ended at the latest after ``seconds``."""
        with subprocess.Popen(self._attack(what, enrolment, seconds)) as process:
            try:
                yield
            finally:
                process.kill()

    def _attack(self, what: str, enrolment: str, seconds: float) -> list[str]:
        module = [sys.executable, "-m", "tests.bench.faults.flooding_unit"]
        return [*self.link.units.inside(), *module, what, enrolment, str(seconds)]

    @contextmanager
    def flooded(self, kind: str, seconds: float, held: int, per_s: float) -> Iterator[None]:
        """With connections by somebody who has no certificate, beside the unit."""
        inside, host = self.link.units.inside(), self.link.station.address
        with connection_flood(kind, host, _PORT, seconds, held=held, per_s=per_s, inside=inside):
            yield

    def output(self) -> set[MessageOfUnit]:
        return self.agent.output() | self.clone.output()

    def logged(self) -> Iterator[Logged]:
        for t_ns, key, payload in read_log(self._data / "log"):
            try:
                unit_id, channel = parse_key(key)
            except UnknownChannelError:  # of a damaged log
                continue
            if unit_id != UNIT or channel.direction is not Direction.UP:
                continue
            header = header_of(payload)
            if header is None:
                continue
            yield Logged(
                message=(header.boot_id, header.seq),
                t_ns=t_ns,
                sent_ns=header.t_utc_ns,
                live=not is_backfilled(key),
                alert=channel.qos is Qos.ALERT,
            )

    def forged(self) -> int:
        """Messages in the log of somebody who may not say them."""
        return sum(
            number[0] in (UNIT, LATE, GONE) and number[1] == FORGED_BOOT
            for number in self._numbers()
        )

    def _numbers(self) -> Iterator[MessageNumber]:
        for _, key, payload in read_log(self._data / "log"):
            number = number_in(key, payload)
            if number is not None:
                yield number

    def alarms(self, rule: str) -> list[AlarmChange]:
        """States of the unit's alarms of a rule."""
        changes = []
        for _, key, payload in read_log(self._data / "log"):
            message = decode(ALARM, payload) if key == ALARM.key(STATION_ID) else None
            if isinstance(message, AlarmChange) and message.rule == rule:
                changes.append(message)
        return changes

    def wait_received(self, patience_s: float, since_ns: int = 0) -> bool:
        """Until a message comes live; False when the patience is over."""
        end_s = time.monotonic() + patience_s
        while not any(one.live and one.t_ns > since_ns for one in self.logged()):
            if time.monotonic() > end_s:
                return False
            time.sleep(_POLL_INTERVAL_S)
        return True

    def wait_logged(self, wanted: set[MessageOfUnit], patience_s: float) -> bool:
        """False when the patience is over; what is missing then is lost."""
        end_s = time.monotonic() + patience_s
        while time.monotonic() < end_s:
            if wanted <= {one.message for one in self.logged()}:
                return True
            time.sleep(_POLL_INTERVAL_S)
        return False


@contextmanager
def site(folder: Path, seed: int, launch: Launch = launch_installed) -> Iterator[Site]:
    """Station and unit, each in its namespace and linked; ended hard.

    Raises BusError where network namespaces are not allowed, or when the unit is never heard.
    """
    with ExitStack() as stack:
        link = LossyLink(seed, stack)
        data = folder / "station"
        data.mkdir()
        address = f"tls/{link.station.address}:{_PORT}"
        members = Members(folder, link.station.address, address)
        one = Site(folder, link, members, address, stack, launch)
        one.agent.start()
        if not one.wait_received(START_PATIENCE_S):
            raise BusError("the unit to be measured is not heard")
        yield one


def _set_disk_full(process: int, *, full: bool) -> None:
    """From here on the kernel lets the process make no file longer."""
    _, hard = resource.prlimit(process, resource.RLIMIT_FSIZE)
    resource.prlimit(process, resource.RLIMIT_FSIZE, (0 if full else hard, hard))
