"""Faults that are done to a station and a unit, one after the other: ``FAULTS``."""

from __future__ import annotations

import random
import time
from dataclasses import dataclass
from typing import Protocol

from tests.bench.faults.attack_scenarios import MEDDLING
from tests.bench.faults.site import START_PATIENCE_S, Site
from tests.rig.link_forwarder import Conditions
from tests.rig.lossy_link import CLEAN, DARK

THIN = Conditions(delay_s=0.05, rate_bps=20_000.0)
POOR = Conditions(loss=0.1, delay_s=0.03, jitter_s=0.1)
_WRITTEN_S = 1.0  # until what had to wait for the disk is in the journal
_LAST_MESSAGES_S = 10.0  # until what a unit sent before it stopped is in the log
_RESTARTS = 3
_DAY_AFTER_S = 15.0  # from the start of an agent to the jump of its clock


class Fault(Protocol):
    """One row of the table."""

    @property
    def name(self) -> str: ...

    @property
    def seconds(self) -> float:
        """Approximate duration."""
        ...

    @property
    def bench_only(self) -> bool:
        """For the benchmark, not for the suite."""
        ...

    @property
    def after(self) -> Conditions:
        """The link from then on, until all that was said has arrived."""
        ...

    def happen(self, site: Site) -> None:
        """Returns when it is over."""
        ...


@dataclass(frozen=True, slots=True)
class BadLink:
    name: str
    link: Conditions  # both ways
    seconds: float
    after: Conditions = CLEAN
    bench_only: bool = False

    def happen(self, site: Site) -> None:
        site.link.set(self.link)
        if not self.link.dark:
            site.ask_par()
        time.sleep(self.seconds)


@dataclass(frozen=True, slots=True)
class Kills:
    """``kill -9`` at random instants, over a poor link."""

    name: str
    agent: bool
    station: bool
    rounds: int
    bench_only: bool = False
    after: Conditions = CLEAN

    @property
    def seconds(self) -> float:
        return 10.0 * self.rounds

    def happen(self, site: Site) -> None:
        chance = random.Random(self.name)  # no secret
        site.link.set(POOR)
        for _ in range(self.rounds):
            time.sleep(3.0 * chance.random())
            if self.agent:
                site.agent.kill()
            if self.station:
                site.kill_station()
            time.sleep(chance.random())
            began_ns = time.time_ns()
            if self.station:
                site.start_station()
            if self.agent:
                site.agent.start()
            site.wait_received(START_PATIENCE_S, began_ns)


@dataclass(frozen=True, slots=True)
class Clone:
    """Another machine with a copy of the enrolment speaks, through an outage too."""

    name: str = "cloned unit"
    seconds: float = 25.0
    bench_only: bool = False
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        before = site.clone.output()
        site.clone.start()
        end_s = time.monotonic() + START_PATIENCE_S
        while time.monotonic() < end_s and len(site.clone.output() - before) < 50:
            time.sleep(0.5)
        time.sleep(10.0)
        site.link.set(DARK)
        time.sleep(6.0)
        site.link.set(CLEAN)
        site.wait_logged(site.output(), START_PATIENCE_S)
        site.clone.stop()  # killed, it would take with it what it has just said
        for _ in range(_RESTARTS):  # stopped without a link, it has the rest in its journal
            if site.wait_logged(site.clone.output(), _LAST_MESSAGES_S):
                return
            site.clone.start()
            site.wait_logged(site.output(), START_PATIENCE_S)
            site.clone.stop()


@dataclass(frozen=True, slots=True)
class ClockJump:
    """The unit's clock is set by a day while it runs, and the link goes for a while."""

    name: str
    days: int
    seconds: float = 25.0
    bench_only: bool = False
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        site.agent.kill()
        began_ns = time.time_ns()
        site.agent.start_with_jumping_clock(self.days, _DAY_AFTER_S)
        site.wait_received(START_PATIENCE_S, began_ns)
        site.link.set(DARK)
        time.sleep(self.seconds)


@dataclass(frozen=True, slots=True)
class Suspended:
    """The station and its router stand still, and go on where they were."""

    name: str
    seconds: float
    bench_only: bool = False
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        with site.suspended_station():
            time.sleep(self.seconds)


@dataclass(frozen=True, slots=True)
class FullDisk:
    name: str
    agent: bool
    station: bool
    seconds: float = 6.0
    bench_only: bool = False
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        self._set(site, full=True)
        time.sleep(self.seconds)
        self._set(site, full=False)
        time.sleep(_WRITTEN_S)

    def _set(self, site: Site, *, full: bool) -> None:
        if self.agent:
            site.agent.set_disk_full(full=full)
        if self.station:
            site.set_station_disk_full(full=full)


@dataclass(frozen=True, slots=True)
class DamagedLog:
    """The station is killed, and its disk does not give back the log as it was."""

    name: str = "log torn, bits flipped"
    seconds: float = 20.0  # the station saves its state meanwhile
    bench_only: bool = False
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        time.sleep(self.seconds)
        site.kill_station()
        site.damage_log(random.Random(self.name))  # no secret
        began_ns = time.time_ns()
        site.start_station()
        site.wait_received(START_PATIENCE_S, began_ns)


TEN_MINUTES = BadLink("outage of 600 s", DARK, 600.0)
FAULTS: tuple[Fault, ...] = (
    BadLink("40 % loss, 300 ms jitter", Conditions(loss=0.4, jitter_s=0.3), 20.0),
    BadLink("outage of 1 s", DARK, 1.0),
    BadLink("outage of 30 s", DARK, 30.0),
    BadLink("20 kbit/s", THIN, 10.0, after=THIN),
    BadLink("outage of 10 s at 20 kbit/s", DARK, 10.0, after=THIN),
    BadLink("outage of 30 s at 20 kbit/s", DARK, 30.0, after=THIN, bench_only=True),
    TEN_MINUTES,
    FullDisk("disk full at the unit", agent=True, station=False),
    FullDisk("disk full at the station", agent=False, station=True),
    Suspended("station stands still for 10 s", 10.0),
    Suspended("station stands still for 45 s", 45.0, bench_only=True),
    DamagedLog(),
    Clone(),
    ClockJump("clock a day ahead", 1, bench_only=True),
    ClockJump("clock a day back", -1, bench_only=True),
    Kills("kill -9 of the agent", agent=True, station=False, rounds=3, bench_only=True),
    Kills("kill -9 of the station", agent=False, station=True, rounds=3, bench_only=True),
    Kills("kill -9 of both", agent=True, station=True, rounds=2),
    *MEDDLING,
)
