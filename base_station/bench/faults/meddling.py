"""Others at the bus and at the console who do no good to a station and its unit."""

from __future__ import annotations

import time
from dataclasses import dataclass

from base_station.bench.faults.members import BABBLER, GONE, LATE, OTHER, UNIT
from base_station.bench.faults.site import Site
from base_station.bench.rig.forwarder import Conditions
from base_station.bench.rig.lossy_link import CLEAN
from base_station.bench.rig.onlookers import Onlookers


@dataclass(frozen=True, slots=True)
class Meddling:
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
class Crowd:
    """Many look on, and some of them read slowly."""

    name: str
    quick: int
    slow: int
    seconds: float = 10.0
    bench_only: bool = True
    after: Conditions = CLEAN

    def happen(self, site: Site) -> None:
        api = site.link.station.call(lambda: site.station.api)
        crowd = site.link.station.call(lambda: Onlookers(api, self.quick, self.slow))
        time.sleep(self.seconds)
        crowd.close()


MEDDLING = (
    Meddling("said again, in any order, backdated", "repeat", "unit"),
    Meddling("messages that make no sense", "babble", "babbler", (BABBLER,)),
    Meddling("A speaks as B", "forge", "other", (OTHER, UNIT), bench_only=True),
    Meddling("certificate: none", "forge", "without", bench_only=True),
    Meddling("certificate: foreign", "forge", "foreign", bench_only=True),
    Meddling("certificate: expired", "forge", "expired", (LATE, UNIT), bench_only=True),
    Meddling("certificate: revoked", "forge", "revoked", (GONE, UNIT), bench_only=True),
    Crowd("200 consoles, and 5 that hardly read", 200, 5),
)
