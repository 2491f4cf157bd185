"""Remote procedure calls between two stations: questions under their keys, asked in rounds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from base_station.standby.protocol import key_of
from shared.bus import Bus, QueryHandler

_TIMEOUT_S = 5.0


class RpcServer:
    """Serves a station's answers until it is closed."""

    def __init__(self, station: str, bus: Bus, answers: Mapping[str, QueryHandler]) -> None:
        self._serving = [
            bus.serve(key_of(station, what), answer) for what, answer in answers.items()
        ]

    def close(self) -> None:
        for subscription in self._serving:
            subscription.close()


def ask(bus: Bus, station: str, what: str, payload: bytes = b"") -> Iterable[bytes]:
    """What the station answers; nothing where it is not there, or has nothing to say."""
    return bus.query(key_of(station, what), payload, _TIMEOUT_S)
