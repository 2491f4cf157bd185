"""The bad links of the other tests have their stated losses."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing

import pytest

from tests.rig.link_forwarder import Conditions
from tests.rig.lossy_link import CLEAN, DARK, LossyLink

SEED = 5
PORT = 5000

pytestmark = pytest.mark.usefixtures("links")


class Datagrams:
    """Numbers sent from the unit's end of a link and those that arrive at the station's."""

    def __init__(self, link: LossyLink, closing_all: ExitStack) -> None:
        self.link = link
        self._sender, self._receiver = (
            closing_all.enter_context(
                closing(one.call(lambda: socket.socket(type=socket.SOCK_DGRAM)))
            )
            for one in (link.units, link.station)
        )
        self._receiver.bind((link.station.address, PORT))

    def arrived(self, count: int, size: int = 4, quiet_s: float = 0.6) -> list[int]:
        """Numbers of ``count`` datagrams sent now, in the order of their arrival."""
        numbers: list[int] = []
        self._receiver.settimeout(0.001)
        for number in range(count):
            payload = number.to_bytes(4, "big").ljust(size)
            self._sender.sendto(payload, (self.link.station.address, PORT))
            numbers += self._received()
        self._receiver.settimeout(quiet_s)
        return numbers + self._received()

    def _received(self) -> list[int]:
        numbers = []
        try:
            while True:
                numbers.append(int.from_bytes(self._receiver.recv(2048)[:4], "big"))
        except TimeoutError:
            return numbers


@pytest.fixture
def datagrams() -> Iterator[Datagrams]:
    with ExitStack() as ended:
        yield Datagrams(LossyLink(SEED, ended), ended)


def test_clean_link_delivers_everything_in_order(datagrams: Datagrams) -> None:
    assert datagrams.arrived(100) == list(range(100))


def test_dark_link_delivers_nothing_until_it_is_clean(datagrams: Datagrams) -> None:
    datagrams.link.set(DARK)
    assert datagrams.arrived(20) == []
    datagrams.link.set(CLEAN)
    assert datagrams.arrived(20) == list(range(20))


def test_each_direction_has_its_own_conditions(datagrams: Datagrams) -> None:
    datagrams.link.set(down=DARK, up=CLEAN)
    assert datagrams.arrived(20) == list(range(20))


def test_loss_and_jitter_are_as_configured(datagrams: Datagrams) -> None:
    datagrams.link.set(Conditions(loss=0.4, jitter_s=0.3))
    arrived = datagrams.arrived(1000)
    assert 0.55 < len(arrived) / 1000 < 0.65
    assert arrived != sorted(arrived)
    assert len(set(arrived)) == len(arrived)


def test_thin_link_limits_the_rate_and_drops_the_excess(
    datagrams: Datagrams,
) -> None:
    datagrams.link.set(Conditions(rate_bps=80_000.0))
    began_s = time.monotonic()
    arrived = datagrams.arrived(40, size=1000)
    assert time.monotonic() - began_s >= len(arrived) * 8_000 / 80_000.0
    assert 0 < len(arrived) < 40
