"""Source of a simulated wearer."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.parse import parse_qsl

from edge.samples import SensorBatch, SensorDescription
from edge.simulation.factory import open_simulation
from edge.sources.interface import OfflineSource, Outage


class SimulatedSource(OfflineSource):
    """``NAME`` or ``PATH.toml``, with ``?seed=N&worn_on=chest``; the truth is in ``simulation``.

    ``&number=1`` is a second sensor of the same person, which gives inertial samples only.
    """

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


def worn_by_one(text: str, number: int, place: str) -> str:
    """Return the text of a simulated source as the sensor of this number, worn at ``place``; what
    the text says itself stays.
    """
    _, _, query = text.partition("?")
    options = dict(parse_qsl(query, keep_blank_values=True))
    added = {"number": str(number)} if number else {}
    if place:
        added["worn_on"] = place
    new = "&".join(f"{key}={value}" for key, value in added.items() if key not in options)
    if not new:
        return text
    return f"{text}{'&' if query else '?'}{new}"
