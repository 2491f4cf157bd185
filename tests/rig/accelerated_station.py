"""A whole station but for its network, in which time goes by as fast as its work is done.

Log, pipeline, database and consoles are the real ones, each with its own thread.  Wearers say
what they would say in 50 ms, the drive takes one turn, and the clock goes on by 50 ms: an hour
of many units takes minutes, and what is measured is work, not waiting.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from base_station.api.hub import Hub
from base_station.api.hub_client import Client
from base_station.core.alarms import ALARMS
from base_station.core.pipeline import StationPipeline
from base_station.engine.engine import StationEngine
from base_station.engine.ports import ActionResult, EnginePorts, Record
from base_station.fusion import FUSERS
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.known_people import person_lookup
from base_station.storage.db.projection import SqlProjection
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.recorder import Recorder
from base_station.storage.segment_index import SegmentIndex
from base_station.views.station import StationFacts
from shared.channels import channel_of
from shared.clock import NS_PER_S, Clock, ManualClock, SystemClock
from shared.codec import encode
from shared.messages import STATION_ID, Message
from shared.messages.station import Action, RegisterUnit, SetAnchor
from tests.rig.simulated_units import Wearer

MakeWearer = Callable[[str, Clock], Wearer]

_STEP_S = 0.05
_PATIENCE_S = 60.0
_CONSOLES = "bench-consoles"
_PARTS = {
    "station-drive": "decode, step, tell",
    "recorder": "log",
    "sql-projection": "database",
    _CONSOLES: "consoles",
}


class CompressedStation:
    """Made by ``compressed_station``."""

    def __init__(
        self,
        folder: Path,
        units: Sequence[str],
        rate_hz: float,
        consoles: int,
        closing: ExitStack,
        make_wearer: MakeWearer,
    ) -> None:
        """``rate_hz``: messages a second of each unit."""
        clock = ManualClock(time.time_ns())
        self._feed = _Wearers([make_wearer(unit, clock) for unit in units], rate_hz, clock)
        data = DataFolder(folder)
        recorder = Recorder(data.path, SystemClock())
        closing.callback(recorder.close)
        store = closing.enter_context(Store(data.database))
        projection = SqlProjection(store)
        closing.callback(projection.close)
        index = SegmentIndex(Records(store, clock), {})
        closing.callback(lambda: index.update(recorder.segments()))
        hub = Hub()
        drive = StationEngine(
            StationPipeline(ALARMS, FUSERS[0]),
            EnginePorts(
                feed=self._feed,
                log=recorder,
                live=hub,
                projection=projection,
                checkpoints=Checkpoints(data.checkpoints),
                people=person_lookup({}),
                facts=StationFacts,
                report=lambda *_: None,
                linked=frozenset,
                unlinked=frozenset,
                send_orders=lambda _: None,
                clock=clock,
                boot_id=clock.utc_ns(),
            ),
        )
        self._watching = closing.enter_context(_watching(hub, drive, consoles))
        self._drive = drive
        drive.start()
        closing.callback(drive.stop)
        drive.submit(STATION_ID, SetAnchor(52.0, 4.0, 0.0, 0.0))
        for unit in units:
            self.act(RegisterUnit(unit, unit))

    @property
    def messages(self) -> int:
        """That the wearers have said."""
        return self._feed.given

    @property
    def console_messages(self) -> int:
        """Snapshots and deltas that the consoles took."""
        return sum(self._watching)

    def run(self, seconds: float) -> None:
        """Let so much of the station's time go by."""
        self._feed.run(seconds)

    def act(self, action: Action) -> ActionResult:
        return self._drive.submit(STATION_ID, action).result(_PATIENCE_S)

    def cpu_s(self) -> dict[str, float]:
        """Processor time of each part since the start, without that of the simulation."""
        spent = {
            _PARTS[thread.name]: time.clock_gettime(time.pthread_getcpuclockid(thread.ident))
            for thread in threading.enumerate()
            if thread.name in _PARTS and thread.ident is not None
        }
        return spent | {"decode, step, tell": spent["decode, step, tell"] - self._feed.cpu_s}


@contextmanager
def compressed_station(
    folder: Path,
    units: Sequence[str],
    rate_hz: float,
    consoles: int,
    make_wearer: MakeWearer = Wearer,
) -> Iterator[CompressedStation]:
    """Closed in order at the end: ``folder`` then is what a station leaves behind."""
    with ExitStack() as closing:
        yield CompressedStation(folder, units, rate_hz, consoles, closing, make_wearer)


class _Wearers:
    """A ``Feed`` that has what its wearers say in the next step of time."""

    def __init__(self, wearers: Sequence[Wearer], rate_hz: float, clock: ManualClock) -> None:
        self._wearers = wearers
        self._rate_hz = rate_hz * len(wearers)
        self._clock = clock
        self._began_ns = clock.monotonic_ns()
        self._changed = threading.Condition()
        self._until_ns = self._began_ns
        self._woken = False
        self.given = 0
        self.cpu_s = 0.0

    @property
    def follows(self) -> bool:
        return False

    def run(self, seconds: float) -> None:
        with self._changed:
            self._until_ns = self._clock.monotonic_ns() + round(seconds * NS_PER_S)
            self._changed.notify_all()
            self._changed.wait_for(self._is_over)

    def take(self, timeout_s: float) -> list[Record]:
        with self._changed:
            if self._is_over():
                self._changed.notify_all()
                self._changed.wait_for(lambda: self._woken or not self._is_over(), timeout_s)
                self._woken = False
                return []
        return self._stated()

    def wake(self) -> None:
        with self._changed:
            self._woken = True
            self._changed.notify_all()

    def _is_over(self) -> bool:
        return self._clock.monotonic_ns() >= self._until_ns

    def _stated(self) -> list[Record]:
        before_s = time.thread_time()
        self._clock.advance(_STEP_S)
        since_s = (self._clock.monotonic_ns() - self._began_ns) / NS_PER_S
        wearers, due = self._wearers, round(since_s * self._rate_hz)
        numbers = range(self.given, due)
        records = [self._record(wearers[number % len(wearers)]) for number in numbers]
        self.given = due
        self.cpu_s += time.thread_time() - before_s
        return records

    def _record(self, wearer: Wearer) -> Record:
        introduces_itself = self.given < len(self._wearers)
        message: Message = wearer.introduction() if introduces_itself else wearer.next_message()
        return self._clock.utc_ns(), channel_of(message).key(wearer.unit_id), encode(message)


@contextmanager
def _watching(hub: Hub, drive: StationEngine, consoles: int) -> Iterator[list[int]]:
    """Clients of the hub in a loop of their own; how many messages each has taken."""
    taken = [0] * consoles
    loop = asyncio.new_event_loop()

    async def watch(number: int, client: Client) -> None:
        while True:
            await client.next_message()
            taken[number] += 1

    def run() -> None:
        hub.connect(loop, drive)
        watching = [loop.create_task(watch(n, hub.join())) for n in range(consoles)]
        loop.run_forever()
        for task in watching:
            task.cancel()
        for task in watching:
            with suppress(asyncio.CancelledError):
                loop.run_until_complete(task)

    thread = threading.Thread(target=run, name=_CONSOLES, daemon=True)
    thread.start()
    try:
        yield taken
    finally:
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()
