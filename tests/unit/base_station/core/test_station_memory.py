"""Memory of a station: beyond what is drawn and kept at hand, a wearer who walks on adds a few
bytes a second, however long; nothing else grows.
"""

from __future__ import annotations

import gc
import math
import sys
from collections.abc import Iterable
from itertools import count
from types import BuiltinFunctionType, FunctionType, ModuleType

import msgspec
import numpy as np
import pytest

from base_station.engine.console_publisher import ConsolePublisher
from base_station.engine.health_monitor import HealthMonitor
from base_station.engine.projector import Projector
from base_station.engine.write_ahead import WriteAhead
from base_station.fusion.odometry.path_history import PathHistory
from base_station.storage.db.known_people import person_lookup
from shared.channels import OPERATOR, POSITION, STATUS, TICK
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import STATION_ID, Header, Message, OperatorAction, Tick
from shared.messages.station import Action, RegisterUnit, SetAnchor
from tests.bench.fusion.simulated_walks import RATE_HZ, Receiver, Walk
from tests.rig import message_factory
from tests.rig.live_station import Screen, make_pipeline

UNIT = "FF-01"
FULL_S, LATE_S = 45 * 60, 81 * 60  # by then trails, and points that correct late fixes, are full
BYTES_A_SECOND = 17.0  # half a megabyte a minute of 500 wearers
NO_DATA = (type, ModuleType, FunctionType, BuiltinFunctionType)


class Room:
    """A log that accepts every record and keeps none."""

    problem, low_disk_space, is_behind, refuses = "", "", False, False

    def write(self, _t_ns: int, _key: str, _payload: bytes) -> bool:
        return True

    def flush(self) -> bool:
        return True


class Station:
    """A pipeline and a publisher, without threads."""

    def __init__(self) -> None:
        self.pipeline, self.screen, self.projector = make_pipeline(), Screen(), Projector()
        self.publisher = ConsolePublisher(self.pipeline, self.screen, person_lookup({}))
        self.keeping = WriteAhead(
            self.pipeline, Room(), (self.publisher,), self.projector, HealthMonitor()
        )
        self.t_ns = 1000 * NS_PER_S
        self.stated = {STATION_ID: count(1), UNIT: count(1)}
        self.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
        self.act(RegisterUnit(UNIT, UNIT))

    def act(self, action: Action) -> None:
        header = self.header(STATION_ID)
        done = OperatorAction(header, str(header.seq), "chief", action)
        self.receive(OPERATOR.key(STATION_ID), done)

    def header(self, sender: str) -> Header:
        return Header(sender, 1, next(self.stated[sender]), self.t_ns, self.t_ns)

    def receive(self, key: str, message: Message) -> None:
        self.keeping.append_and_apply(self.t_ns, key, encode(message))

    def publish(self) -> None:
        self.projector.take(self.t_ns)
        self.publisher.publish_delta(health=True)
        self.screen.deltas.clear()

    @property
    def path(self) -> PathHistory:
        return self.pipeline.state.paths[UNIT]

    @property
    def own_bytes(self) -> int:
        """Size of everything but the path and learnt storeys; the number of those is bounded."""
        return size_bytes([self.keeping], (self.path, self.pipeline.state.site.learnt_floors))


def walk_on(station: Station, walk: Walk, rng: np.random.Generator, until_s: int) -> None:
    for second in range(station.t_ns // NS_PER_S - 1000, until_s):
        row = second * RATE_HZ
        ahead_m = walk.own_m[row + RATE_HZ] - walk.own_m[row]
        position = walk.position(row)
        station.t_ns = position.header.t_mono_ns
        walked = msgspec.structs.replace(
            position,
            header=station.header(UNIT),
            heading_rad=rng.normal(math.atan2(ahead_m[1], ahead_m[0]), 0.05),
            std_north_m=0.1 + 0.005 * position.distance_m,
        )
        station.receive(POSITION.key(UNIT), walked)
        station.receive(STATUS.key(UNIT), message_factory.status(station.header(UNIT)))
        station.receive(TICK.key(STATION_ID), Tick(station.header(STATION_ID), station.t_ns))
        station.publish()


def size_bytes(of: Iterable[object], but: Iterable[object] = ()) -> int:
    """Size of these objects and of all objects that they refer to."""
    seen = {*map(id, but)}
    waiting, total = list(of), 0
    while waiting:
        one = waiting.pop()
        if id(one) not in seen and not isinstance(one, NO_DATA):
            seen.add(id(one))
            total += sys.getsizeof(one)
            # The collector does not follow references of structs without cycles.
            inside = msgspec.structs.astuple(one) if isinstance(one, msgspec.Struct) else ()
            waiting += [*inside, *gc.get_referents(one)]
    return total


@pytest.fixture(scope="module")
def grown() -> tuple[int, int]:
    """Growth of the path, and of everything else, in bytes."""
    rng, station = np.random.default_rng(3), Station()
    walk = Walk.wander(rng, LATE_S + 60.0)
    sizes = []
    for until_s in (FULL_S, LATE_S):
        walk_on(station, walk, rng, until_s)
        sizes.append((size_bytes([station.path.own.packed]), station.own_bytes))
    (path, rest), (path_later, rest_later) = sizes
    return path_later - path, rest_later - rest


@pytest.mark.slow
def test_path_grows_by_a_few_bytes_a_second(grown: tuple[int, int]) -> None:
    assert 0 < grown[0] < BYTES_A_SECOND * (LATE_S - FULL_S)


@pytest.mark.slow
def test_nothing_else_grows(grown: tuple[int, int]) -> None:
    assert grown[1] < 5_000


@pytest.mark.slow
def test_fixes_grow_by_a_few_bytes_a_second() -> None:
    rng, history = np.random.default_rng(4), PathHistory()
    receiver = Receiver(rng)
    for second in range(LATE_S):
        history.fix(receiver.fix(float(second), np.zeros(2)), second * NS_PER_S)
    assert len(history.arrays().fix_t_ns) == LATE_S // 2
    assert size_bytes([history.fixes]) < 4 * LATE_S
