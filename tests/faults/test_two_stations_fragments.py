"""A client that leaves messages unfinished at both stations of a pair does not stop them copying
plans.
"""

from __future__ import annotations

import dataclasses
import json
import time
import urllib.error
from contextlib import ExitStack, closing, suppress
from pathlib import Path

import psutil

from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import POSITION
from shared.enrolment import Enrolment
from tests.bench.standby.station_of_pair import Place, Station
from tests.rig import processes
from tests.rig.large_plan import large_plan
from tests.rig.pacing import wait_until
from tests.rig.picture_flood import put_file
from tests.rig.two_stations import two_stations
from tests.rig.unfinished_messages import unfinished_messages

UNFINISHED_MB = 110.0  # of four links, in each of seven priorities 2 MB, and what was read of them
SIZES = (1_900_000, 60_000_000, 1_900_000, 60_000_000, 1_900_000, 60_000_000)
PLAN_BYTES = 4_000_000  # no router takes as much at once


def router_pid(station: Station) -> int:
    assert station.process is not None
    [pid] = (
        one.pid
        for one in psutil.Process(station.process.pid).children(recursive=True)
        if "base_station.security.router" in one.cmdline()
    )
    return pid


def wait_linked(enrolment: Enrolment) -> None:
    """The router knows it, and has what it makes once."""
    with closing(ZenohBus(UnitEndpoint(enrolment.connect, enrolment.identity))) as linked:
        wait_until("it is enrolled", lambda: linked.has_subscriber(POSITION.key(enrolment.name)))


def has_plan(station: Station, plan: bytes) -> bool:
    with suppress(urllib.error.HTTPError):  # 404: it has none yet
        return bool(station.get("/site/plan") == json.loads(plan))
    return False


def test_unfinished_messages_of_a_holder_are_limited_beside_a_standby(
    tmp_path: Path, closing: ExitStack
) -> None:
    two = two_stations(tmp_path, (Place(), Place()), closing)
    two.start()
    enrolled = two.enroll("unfinished", two.first)
    attackers = [dataclasses.replace(enrolled, connect=(one.bus,)) for one in two.both]
    for one in attackers:
        wait_linked(one)
    routers = [router_pid(one) for one in two.both]
    before_mb = [processes.memory_mb(pid) for pid in routers]
    with ExitStack() as unfinished:
        for size in SIZES:
            for one in attackers:
                unfinished.enter_context(unfinished_messages(one, POSITION.key("unfinished"), size))
        time.sleep(2.0)  # what is on its way
        plan = large_plan(PLAN_BYTES)
        api = two.first.logged_in()
        assert put_file(api, "/site/plan", plan, "application/json") == 204
        wait_until("the standby has the plan", lambda: has_plan(two.second, plan))
        for pid, first_mb in zip(routers, before_mb, strict=True):
            assert processes.memory_mb(pid) < first_mb + UNFINISHED_MB
    assert two.leader() is two.first
