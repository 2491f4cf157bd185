"""A script whose units may be out of reach: what they say then waits in their journals."""

from __future__ import annotations

import math

from base_station.core.events import Output
from base_station.core.pipeline import StationPipeline
from shared.channels import backfilled_key, channel_of
from shared.codec import encode
from shared.messages import Message
from tests.rig.station_script import Script


class JournaledScript(Script):
    def __init__(self, pipeline: StationPipeline | None = None) -> None:
        super().__init__(pipeline)
        self.out_of_reach: set[str] = set()
        self._journals: dict[str, list[Message]] = {}

    def say(self, message: Message) -> list[Output]:
        unit_id = message.header.unit_id
        if unit_id not in self.out_of_reach:
            return super().say(message)
        self._journals.setdefault(unit_id, []).append(message)
        return []

    def fetch(self, unit_id: str, pieces: int = 2) -> list[Output]:
        """Delivers the messages that wait in the journal, the newest piece first."""
        held = self._journals.pop(unit_id)
        size = math.ceil(len(held) / pieces)
        outputs: list[Output] = []
        for begin in reversed(range(0, len(held), size)):
            for message in held[begin : begin + size]:
                key = backfilled_key(unit_id, channel_of(message).suffix)
                outputs += self.record(key, encode(message))
        return outputs
