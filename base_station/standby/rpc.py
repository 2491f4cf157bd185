"""Remote procedure calls between two stations: questions under their keys, asked in rounds.

An answer travels in pieces: no router has to take larger messages than those that units send,
and what a unit leaves unfinished there is bounded beside a standby as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from base_station.standby.protocol import key_of
from shared.bus import Bus, QueryHandler

_TIMEOUT_S = 5.0
_PIECE_BYTES = 512 * 1024
_MORE, _LAST = b"\x01", b"\x00"  # before each piece: whether another of its answer follows


class RpcServer:
    """Serves a station's answers until it is closed."""

    def __init__(self, station: str, bus: Bus, answers: Mapping[str, QueryHandler]) -> None:
        self._serving = [
            bus.serve(key_of(station, what), _in_pieces(answer)) for what, answer in answers.items()
        ]

    def close(self) -> None:
        for subscription in self._serving:
            subscription.close()


def ask(
    bus: Bus, station: str, what: str, payload: bytes = b"", timeout_s: float = _TIMEOUT_S
) -> Iterator[bytes]:
    """Answers of the station; none where it is not there, or has none."""
    pieces: list[bytes] = []
    for piece in bus.query(key_of(station, what), payload, timeout_s):
        pieces.append(piece[1:])
        if piece.startswith(_LAST):
            yield b"".join(pieces)
            pieces.clear()


def _in_pieces(answer: QueryHandler) -> QueryHandler:
    def replies(key: str, parameters: str, payload: bytes) -> Iterator[bytes]:
        for whole in answer(key, parameters, payload):
            last = max(len(whole) - 1, 0) // _PIECE_BYTES
            for number in range(last + 1):
                begin = number * _PIECE_BYTES
                mark = _MORE if number < last else _LAST
                yield mark + whole[begin : begin + _PIECE_BYTES]

    return replies
