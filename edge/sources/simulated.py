"""Source of a simulated wearer."""

from __future__ import annotations

from collections.abc import Iterator

from edge.samples import SensorBatch, SensorDescription
from edge.simulation.factory import open_simulation
from edge.sources.interface import OfflineSource, Outage


class SimulatedSource(OfflineSource):
    """``NAME`` or ``PATH.toml``, with ``?seed=N&worn_on=chest``; the truth is in ``simulation``."""

    def __init__(self, text: str, batch_s: float = 0.05) -> None:
        self.simulation = open_simulation(text)
        self._batch_s = batch_s

    @property
    def description(self) -> SensorDescription:
        return self.simulation.description

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return tuple(Outage(*times) for times in self.simulation.scenario.radio_outages_s)

    def batches(self) -> Iterator[SensorBatch]:
        return self.simulation.batches(self._batch_s)
