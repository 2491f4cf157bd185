"""Source of a simulated unit on a table, handled as a calibration asks for."""

from __future__ import annotations

from collections.abc import Iterator

from edge.samples import SensorBatch, SensorDescription
from edge.simulation.handled_unit import HandledUnit, cut
from edge.sources.interface import OfflineSource
from shared.errors import ConfigError


class TabletopSource(OfflineSource):
    """Source; ``text`` is the seed of the sensors' errors; the same seed is the same unit."""

    def __init__(self, text: str) -> None:
        if not text.isdecimal():
            raise ConfigError(f"bench:{text}: the seed is a whole number from 0 up, as in bench:1")
        self._seed = int(text)

    @property
    def description(self) -> SensorDescription:
        return HandledUnit(self._seed).description

    def batches(self) -> Iterator[SensorBatch]:
        return cut(HandledUnit(self._seed).calibrated_by_the_book())
