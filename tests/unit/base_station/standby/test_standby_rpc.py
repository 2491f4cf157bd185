"""Answers between stations travel in pieces, and arrive complete or not at all."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from base_station.standby.rpc import RpcServer, ask
from shared.bus_memory import MemoryRouter

PIECE = 512 * 1024


@pytest.mark.parametrize("size", [0, 1, PIECE, PIECE + 1, 12_000_000])
def test_answer_of_any_size_arrives_complete(size: int) -> None:
    router = MemoryRouter()
    answers = [bytes([number]) * size for number in range(3)]
    RpcServer("first", router.attach_station(), {"plan": lambda *_: iter(answers)})
    assert list(ask(router.attach_station(), "first", "plan")) == answers


def test_no_piece_is_larger_than_a_router_takes() -> None:
    router = MemoryRouter()
    RpcServer("first", router.attach_station(), {"plan": lambda *_: iter([bytes(12_000_000)])})
    pieces = router.attach_station().query("muster/stations/v1/first/plan", b"", 5.0)
    assert max(map(len, pieces)) <= PIECE + 1


def test_truncated_answer_is_refused() -> None:
    def killed(*_: object) -> Iterator[bytes]:
        yield b"\x00whole"
        yield b"\x01the beginning of"

    router = MemoryRouter()
    router.attach_station().serve("muster/stations/v1/first/plan", killed)
    assert list(ask(router.attach_station(), "first", "plan")) == [b"whole"]
