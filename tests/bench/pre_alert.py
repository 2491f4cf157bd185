"""Pre-alert for ``muster bench wearer``: from when the unit decides until its output begins.

The agent runs in this process, so that the moment is known at which the motionless time passes the
limit; its source plays motion and rest ten times as fast as they were.
"""

from __future__ import annotations

import io
import time
from collections.abc import Iterator
from contextlib import closing, redirect_stdout
from pathlib import Path
from threading import Event
from typing import cast

import numpy as np

from edge.agent.pipeline import LIVE, TrackerPipeline
from edge.agent.wearer_notices import PRE_ALERT_S
from edge.app.composition import compose_agent
from edge.clocks.timeline import Timeline
from edge.config import EdgeConfig
from edge.samples import ImuBatch, SensorBatch, SensorDescription
from edge.sources.interface import OfflineSource
from edge.storage.data_folder import UnitDataFolder
from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.channels import HEARTBEAT
from shared.clock import NS_PER_S
from shared.messages import Message

_SPEED = 10.0
_RATE_HZ = 100.0
_BATCH = 4  # samples
_WORN_S, _MOVES_S, _RESTS_S = 25.0, 5.0, PRE_ALERT_S + 5.0
_PRE_ALERT = "[pre-alert]"


class _MovesAndRests(OfflineSource):
    """Moves for a while, then rests and moves again and again."""

    description = SensorDescription("swing", _RATE_HZ, 160.0, 35.0)

    def __init__(self, rests: int) -> None:
        self._rests = rests

    def batches(self) -> Iterator[SensorBatch]:
        episode = round((_MOVES_S + _RESTS_S) * _RATE_HZ)
        moving = round(_MOVES_S * _RATE_HZ)
        begin = round(_WORN_S * _RATE_HZ)
        for first in range(0, begin + self._rests * episode, _BATCH):
            k = np.arange(first, first + _BATCH)
            moves = (k < begin) | ((k - begin) % episode < moving)
            swing = np.where(moves, np.sin(k / _RATE_HZ * 6.0), 1e-3 * np.sin(7.0 * k))[:, None]
            accel = np.array([[0.0, 0.0, 9.81]]) + 4.0 * swing * np.array([[1.0, 0.5, 0.3]])
            t_ns = (k * (NS_PER_S / _RATE_HZ)).astype(np.int64)
            yield SensorBatch(ImuBatch(t_ns, accel, 2.0 * swing * np.array([[0.2, 1.0, 0.1]])))


class _Station:
    """It is linked, and answers nothing."""

    def __init__(self) -> None:
        self._router = MemoryRouter()
        self._bus = self._router.attach_station()
        self._bus.subscribe(HEARTBEAT.key("*"), lambda _key, _payload: None)

    def open_bus(self) -> Bus:
        return self._router.attach_unit()

    def is_reachable(self, timeout_s: float) -> bool:
        return True

    def link_failure_reason(self) -> str:
        return ""


class _Watched(io.TextIOBase):
    """Standard output of the agent, of which only when a pre-alert is printed is of interest."""

    def __init__(self) -> None:
        self.begun_s: list[float] = []

    def write(self, text: str) -> int:
        if _PRE_ALERT in text:
            self.begun_s.append(time.monotonic())
        return len(text)


def measure_pre_alerts(rests: int, folder: Path) -> list[float]:
    """Return the seconds from each decision to the output."""
    config = EdgeConfig("bench:1", outputs=("terminal:unit",), data=folder)
    decided_s: list[float] = []
    watched = _Watched()
    with closing(UnitDataFolder(folder / "unit")) as data:
        agent = compose_agent(config, "unit", data, _MovesAndRests(rests), _Station(), _SPEED)
        _note_decisions(agent._parts.pipeline, decided_s)
        with redirect_stdout(cast("io.TextIOBase", watched)):
            agent.run(Event())
    return [
        next(begun_s for begun_s in watched.begun_s if begun_s >= at_s) - at_s for at_s in decided_s
    ]


def _note_decisions(pipeline: TrackerPipeline, decided_s: list[float]) -> None:
    step = pipeline.step

    def noted(batch: SensorBatch, timeline: Timeline = LIVE) -> tuple[Message, ...]:
        was_due = pipeline.motionless_s >= PRE_ALERT_S
        messages = step(batch, timeline)
        if pipeline.motionless_s >= PRE_ALERT_S and not was_due:
            decided_s.append(time.monotonic())
        return messages

    pipeline.step = noted  # type: ignore[method-assign]
