"""Age of positions as consoles get them, at a live station whose units walk in real time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event, Lock, Thread

from base_station.views.wire import Delta
from shared.clock import NS_PER_MS, NS_PER_S, Clock, SystemClock
from shared.messages.station import OpenIncident, RegisterUnit, SetStart
from tests.rig.live_station import LiveStation, Screen
from tests.rig.simulated_units import Wearer, unit_names


class PositionAges(Screen):
    """A console that notes of each new position how old it is, and keeps nothing else."""

    def __init__(self, clock: Clock) -> None:
        super().__init__()
        self._clock = clock
        self._lock = Lock()  # guards what follows
        self._ages_ms: list[float] = []
        self._newest_ms: dict[str, int] = {}

    def delta(self, delta: Delta) -> None:
        now_ms = self._clock.utc_ns() / NS_PER_MS
        with self._lock:
            for unit in delta.units:
                position = unit.position
                if position is None or position.t_ms <= self._newest_ms.get(unit.unit_id, 0):
                    continue
                self._newest_ms[unit.unit_id] = position.t_ms
                self._ages_ms.append(now_ms - position.t_ms)

    def take(self) -> list[float]:
        """The ages since it was asked last."""
        with self._lock:
            ages_ms, self._ages_ms = self._ages_ms, []
        return ages_ms


@contextmanager
def live_positions(folder: Path, units: int, rate_hz: float) -> Iterator[PositionAges]:
    """``rate_hz``: messages a second of each unit."""
    clock, over = SystemClock(), Event()
    screen = PositionAges(clock)
    with LiveStation(folder, screen=screen) as station:
        station.act(OpenIncident("live", "bench"))
        wearers = [Wearer(name, clock) for name in unit_names(units)]
        for wearer in wearers:
            station.act(RegisterUnit(wearer.unit_id, ""))
            station.publish(wearer.introduction())
            station.act(SetStart(wearer.unit_id, 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))

        def walk() -> None:
            began_ns, turns = clock.monotonic_ns(), 0
            while not over.is_set():
                wearer = wearers[turns % units]
                station.publish(wearer.next_message())
                turns += 1
                due_ns = began_ns + round(turns * NS_PER_S / (rate_hz * units))
                over.wait(max(due_ns - clock.monotonic_ns(), 0) / NS_PER_S)

        walking = Thread(target=walk, name="bench-wearers")
        walking.start()
        try:
            yield screen
        finally:
            over.set()
            walking.join()
