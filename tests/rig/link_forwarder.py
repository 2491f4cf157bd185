"""The process between two network namespaces: takes packets from one TUN device, spoils them as
told, and hands them to the other.

``python -m tests.rig.link_forwarder SEED NAME NAME`` makes both devices, says ``ready``,
and takes one JSON object of ``Conditions`` a line on its standard input; it ends with that input,
and the devices with it.
"""

from __future__ import annotations

import fcntl
import heapq
import os
import random
import select
import struct
import sys
import time

import msgspec

_SET_INTERFACE = 0x400454CA  # TUNSETIFF
_TUN_WITHOUT_HEADER = 0x1001  # IFF_TUN | IFF_NO_PI
_PACKET_BYTES = 2048
_BUFFER_BYTES = 6000  # four full packets: what a slow modem queues before it throws away


class Conditions(msgspec.Struct, frozen=True):
    """Conditions of one direction of the link; drawn for each packet, so some overtake others."""

    loss: float = 0.0  # part of the packets
    delay_s: float = 0.0
    jitter_s: float = 0.0  # added to the delay, evenly from 0 to this
    rate_bps: float | None = None  # bits a second
    dark: bool = False  # nothing passes


class LinkConditions(msgspec.Struct, frozen=True):
    """Conditions of the link from now on."""

    there: Conditions  # from the first device to the second
    back: Conditions


class Direction:
    """One way through the link."""

    def __init__(self, source: int, sink: int, seed: str) -> None:
        self._source, self._sink = source, sink
        self._chance = random.Random(seed)  # no secret
        self._conditions = Conditions()
        self._free_s = 0.0  # when the sender has sent all that it took
        self._count = 0
        self._waiting: list[tuple[float, int, bytes]] = []  # due, order of arrival

    def set(self, conditions: Conditions) -> None:
        self._conditions = conditions
        self._free_s = 0.0
        if conditions.dark:
            self._waiting.clear()

    def take(self, now_s: float) -> None:
        packet = os.read(self._source, _PACKET_BYTES)
        now = self._conditions
        if now.dark or self._chance.random() < now.loss:
            return
        left_s = now_s
        if now.rate_bps is not None:
            begins_s = max(now_s, self._free_s)
            if (begins_s - now_s) * now.rate_bps > 8 * _BUFFER_BYTES:
                return
            left_s = self._free_s = begins_s + 8 * len(packet) / now.rate_bps
        due_s = left_s + now.delay_s + self._chance.uniform(0.0, now.jitter_s)
        self._count += 1
        heapq.heappush(self._waiting, (due_s, self._count, packet))

    def give(self, now_s: float) -> None:
        """Hand over what is due."""
        while self._waiting and self._waiting[0][0] <= now_s:
            os.write(self._sink, heapq.heappop(self._waiting)[2])

    def due_s(self) -> float | None:
        return self._waiting[0][0] if self._waiting else None


def forward(first: int, second: int, seed: int) -> None:
    """Until the standard input ends."""
    there = Direction(first, second, f"{seed} there")
    back = Direction(second, first, f"{seed} back")
    sources = {first: there, second: back}
    reported = sys.stdin.fileno()

    def receive() -> bool:
        line = sys.stdin.buffer.readline()
        if line:
            conditions = msgspec.json.decode(line, type=LinkConditions)
            there.set(conditions.there)
            back.set(conditions.back)
            print("set", flush=True)
        return bool(line)

    if not receive():  # nothing can be read from a device before it is up
        return
    poll = select.poll()
    for readable in (reported, *sources):
        poll.register(readable, select.POLLIN)
    while True:
        dues_s = [due_s for one in (there, back) if (due_s := one.due_s()) is not None]
        wait_s = max(0.0, min(dues_s) - time.monotonic()) if dues_s else None
        for ready, _ in poll.poll(None if wait_s is None else wait_s * 1000.0):
            if ready != reported:
                sources[ready].take(time.monotonic())
            elif not receive():
                return
        for one in (there, back):
            one.give(time.monotonic())


def make_device(name: str) -> int:
    """A TUN device that lives as long as the returned descriptor.  Raises OSError where that is
    not allowed.
    """
    device = os.open("/dev/net/tun", os.O_RDWR)
    request = struct.pack("16sH22x", name.encode(), _TUN_WITHOUT_HEADER)
    fcntl.ioctl(device, _SET_INTERFACE, request)
    return device


if __name__ == "__main__":
    devices = [make_device(name) for name in sys.argv[2:]]
    print("ready", flush=True)
    forward(devices[0], devices[1], int(sys.argv[1]))
