"""A subscriber that does nothing else, in a process of its own: what the bus alone can do."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from typing import NamedTuple

from shared.bus_zenoh import StationEndpoint, UnitEndpoint, ZenohBus
from shared.channels import Qos
from tests.rig.pacing import paced

_KEY = "bench/bare"
_FLOOD_BYTES = 200
_QUIET_S = 0.5  # nothing for so long: all has come


class BareFigures(NamedTuple):
    sent: int
    received: int
    rate_hz: float  # received
    latencies_ms: tuple[float, ...]  # from publish to the subscriber's handler


@contextmanager
def bare_subscriber(address: str) -> Iterator[Connection]:
    """The far end answers ``(received, first_s, last_s, latencies_ms)`` to each ``"report"``."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_subscribe, args=(address, theirs), daemon=True)
    process.start()
    try:
        ours.recv()  # it listens
        yield ours
    finally:
        ours.send("end")
        process.join()


def measure_steady(
    address: str, far_end: Connection, rate_hz: float, seconds: float
) -> BareFigures:
    """One publisher at ``rate_hz``."""
    bus = _linked(address)
    far_end.send("begin")
    far_end.recv()
    for _ in paced(rate_hz, seconds):
        bus.publish(_KEY, _stamped(), Qos.LIVE)
    return _figures(bus, far_end, round(rate_hz * seconds))


def measure_flood(address: str, far_end: Connection, seconds: float) -> BareFigures:
    """One publisher as fast as it goes; what the link does not take is dropped."""
    bus = _linked(address)
    far_end.send("begin")
    far_end.recv()
    end = time.perf_counter() + seconds
    count = 0
    while time.perf_counter() < end:
        for _ in range(100):
            bus.publish(_KEY, _stamped(), Qos.LIVE)
        count += 100
    return _figures(bus, far_end, count)


def _linked(address: str) -> ZenohBus:
    bus = ZenohBus(UnitEndpoint((address,)))
    while not bus.is_linked():
        time.sleep(0.01)
    time.sleep(0.2)  # for the subscription to get here
    return bus


def _stamped() -> bytes:
    return time.time_ns().to_bytes(8, "big") + bytes(_FLOOD_BYTES - 8)


def _figures(bus: ZenohBus, far_end: Connection, sent: int) -> BareFigures:
    far_end.send("report")
    received, span_s, latencies_ms = far_end.recv()
    bus.close()
    return BareFigures(sent, received, received / span_s if span_s else 0.0, latencies_ms)


def _subscribe(address: str, far_end: Connection) -> None:
    bus = ZenohBus(StationEndpoint((address,)))
    arrivals: list[tuple[int, int]] = []  # sent, heard

    def on_message(_: str, payload: bytes) -> None:
        arrivals.append((int.from_bytes(payload[:8], "big"), time.time_ns()))

    subscription = bus.subscribe(_KEY, on_message)
    far_end.send("listening")
    while (asked := far_end.recv()) != "end":
        if asked == "begin":
            arrivals.clear()
            far_end.send("begun")
            continue
        count = -1
        while count != len(arrivals):
            count = len(arrivals)
            time.sleep(_QUIET_S)
        span_s = (arrivals[-1][1] - arrivals[0][1]) / 1e9 if arrivals else 0.0
        far_end.send((count, span_s, tuple((arrived - sent) / 1e6 for sent, arrived in arrivals)))
    subscription.close()
    bus.close()
