"""Others at the bus and at the console who do no good to a station and its unit."""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import dataclass
from urllib.parse import urlsplit

from tests.bench.faults.bus_identities import BABBLER, GONE, LATE, OTHER, UNIT
from tests.bench.faults.site import Site
from tests.rig.console_load import ConsoleGroup
from tests.rig.link_forwarder import Conditions
from tests.rig.login_flood import Flood, LoginFlood, guesses, slow_bodies
from tests.rig.lossy_link import CLEAN
from tests.rig.pacing import wait_until
from tests.rig.picture_flood import photographs_at_once


@dataclass(frozen=True, slots=True)
class HostileBusClient:
    """Somebody else is on the bus, or tries to be."""

    name: str
    what: str  # one of ``meddler.WHAT``
    who: str  # one of the ``Members``
    names: tuple[str, ...] = (UNIT,)  # in which it speaks
    seconds: float = 8.0
    bench_only: bool = False
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        membership: str = getattr(site.members, self.who)
        site.meddle(self.what, membership, ",".join(self.names), self.seconds)


@dataclass(frozen=True, slots=True)
class ManyConsoles:
    """Many look on, and some of them read slowly."""

    name: str
    quick: int
    slow: int
    seconds: float = 10.0
    bench_only: bool = True
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        api = site.link.station.call(lambda: site.station.api)
        crowd = site.link.station.call(lambda: ConsoleGroup(api, self.quick, self.slow))
        time.sleep(self.seconds)
        crowd.close()


@dataclass(frozen=True, slots=True)
class ConnectionFlood:
    """Somebody without a certificate opens connections; the unit has to link meanwhile."""

    name: str
    kind: str  # one of ``connection_flood.KINDS``
    held: int
    per_s: float
    seconds: float = 15.0
    bench_only: bool = True
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        with site.flooded(self.kind, _FLOODED_S, self.held, self.per_s):
            _link_again(site)


@dataclass(frozen=True, slots=True)
class EarlierUnits:
    """Units of another authority try to link for ever; the unit has to link meanwhile."""

    name: str
    seconds: float = 15.0
    bench_only: bool = True
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        with site.attacked("retry", site.members.foreign, _FLOODED_S):
            time.sleep(_BEGUN_S)
            _link_again(site)


@dataclass(frozen=True, slots=True)
class CertificateHolderAttack:
    """Somebody with a certificate wants to stop the station."""

    name: str
    what: str  # one of ``attacker.ATTACKS``
    who: str  # one of the ``Members``
    seconds: float = 10.0
    bench_only: bool = True
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        site.attack(self.what, getattr(site.members, self.who), self.seconds)


@dataclass(frozen=True, slots=True)
class ConsoleFlood:
    """Clients without a session load the console's address with logins and slow bodies."""

    name: str
    flood: Flood
    addresses: int
    seconds: float = 15.0
    bench_only: bool = True
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        port = site.link.station.call(lambda: urlsplit(site.station.api.origin).port)
        assert port is not None
        with ExitStack() as flooded:
            # The thread of the flood stays in the network of whoever starts it.
            site.link.station.call(
                lambda: flooded.enter_context(LoginFlood(port, self.flood, places=self.addresses))
            )
            site.ask_par()
            time.sleep(self.seconds)


@dataclass(frozen=True, slots=True)
class Photographs:
    """Users put large pictures, all at once."""

    name: str
    count: int
    seconds: float = 15.0  # about
    bench_only: bool = True
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        with ExitStack() as sent:
            # The threads of the senders stay in the network of whoever starts them.
            site.link.station.call(
                lambda: sent.enter_context(photographs_at_once(site.station.api, self.count))
            )
            site.ask_par()


def _link_again(site: Site) -> None:
    """The unit's agent, from its start."""
    site.agent.kill()
    before = site.agent.output()
    site.agent.start()
    wait_until("the agent has begun", lambda: site.agent.output() > before)
    time.sleep(_LINKED_WITHIN_S)


_BEGUN_S = 4.0  # until forty have tried a few times
_FLOODED_S = 120.0  # more than it lasts: it ends when the fault does
_LINKED_WITHIN_S = 3.0  # to reach: else it is heard only after the fault's end

MEDDLING = (
    HostileBusClient("said again, in any order, backdated", "repeat", "unit"),
    HostileBusClient("messages that make no sense", "babble", "babbler", (BABBLER,)),
    HostileBusClient("A speaks as B", "forge", "other", (OTHER, UNIT), bench_only=True),
    HostileBusClient("certificate: none", "forge", "without", bench_only=True),
    HostileBusClient("certificate: foreign", "forge", "foreign", bench_only=True),
    HostileBusClient("certificate: expired", "forge", "expired", (LATE, UNIT), bench_only=True),
    HostileBusClient("certificate: revoked", "forge", "revoked", (GONE, UNIT), bench_only=True),
    ManyConsoles("200 consoles, and 5 that hardly read", 200, 5),
    ConnectionFlood("attack: 1,500 silent connections, 200/s", "silent", held=1500, per_s=200.0),
    ConnectionFlood("attack: 200/s begin a handshake", "hello", held=500, per_s=200.0),
    EarlierUnits("attack: 40 units of another authority"),
    ConsoleFlood("attack: 120 addresses guess passwords", guesses(1.0), 120),
    ConsoleFlood("attack: 1,440 slow bodies from 12 addresses", slow_bodies(120), 12),
    Photographs("attack: 30 photographs of 50 megapixels", 30),
    CertificateHolderAttack("attack: 50 sessions/s, revoked", "sessions", "revoked"),
    CertificateHolderAttack("attack: a journal without end", "journal", "other"),
    CertificateHolderAttack(
        "attack: a journal of 2 kB messages", "large journal", "other", seconds=25.0
    ),
    CertificateHolderAttack("attack: a token comes and goes", "toggle", "babbler"),
)
