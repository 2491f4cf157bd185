"""Source of a simulated wearer."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from urllib.parse import parse_qsl

from edge.samples import SensorBatch, SensorDescription
from edge.simulation.factory import SEGMENTS, open_simulation, segment_at
from edge.sources.interface import OfflineSource, Outage
from shared.errors import ConfigError

logger = logging.getLogger(__name__)


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
    """Return the text of a simulated source as the sensor of this number, worn at ``place``, where
    that is set; what the text says itself stays.  The text of any other source is returned as it
    is.

    Raises ConfigError for a place of which no motion can be simulated.
    """
    scheme, _, argument = text.partition(":")
    if scheme != "simulated" or not argument:
        return text
    _, _, query = text.partition("?")
    options = dict(parse_qsl(query, keep_blank_values=True))
    added = {"number": str(number)} if number else {}
    if place and _is_simulated_at(place, text, options.get("worn_on")):
        added["worn_on"] = place
    new = "&".join(f"{key}={value}" for key, value in added.items() if key not in options)
    if not new:
        return text
    return f"{text}{'&' if query else '?'}{new}"


def _is_simulated_at(place: str, text: str, in_source: str | None) -> bool:
    """Return True where the text leaves the part of the body to the settings of the unit."""
    segment = segment_at(place)
    if in_source is None:
        if segment not in SEGMENTS:
            raise ConfigError(
                f"{text}: no motion can be simulated at {place}, where the sensor is set to be "
                f"worn; say in the source which one is to be in place of it, as worn_on=chest: "
                f"{', '.join(SEGMENTS)}"
            )
        return True
    if segment_at(in_source) != segment:
        logger.warning(
            "%s simulates the motion at %s, as it says, and the unit takes it for one at %s, as is "
            "set",
            text,
            in_source,
            place,
        )
    return False
