"""Parts of an agent, which its runtime loop joins."""

from __future__ import annotations

from dataclasses import dataclass
from queue import SimpleQueue
from typing import Protocol

from edge.agent.link import Link
from edge.agent.mayday_latch import MaydayLatch
from edge.agent.outbox import Outbox
from edge.agent.pipeline import TrackerPipeline
from edge.agent.source_reader import SourceReader
from edge.agent.step_scale_keeper import StepScaleKeeper
from edge.agent.wearer_notifier import WearerNotifier
from edge.clocks.station import StationClock
from edge.sample_codec.codec import SampleEncoder
from edge.samples import SensorBatch
from edge.sources.interface import Source
from edge.storage.black_box.black_box import BlackBox
from edge.storage.journal.journal import Journal
from edge.storage.journal.writer import JournalWriter
from shared.header_factory import HeaderFactory
from shared.messages import PreflightFinding
from shared.service_manager import ServiceManager


class SelfTest(Protocol):
    """Check of the unit at its start, while it runs; see ``edge.preflight.start_check``."""

    def start(self, mono_ns: int) -> None: ...

    def push(self, batch: SensorBatch) -> None: ...

    def step(self, mono_ns: int) -> tuple[PreflightFinding, ...] | None:
        """Return new findings: faults and missing parts."""
        ...


@dataclass(frozen=True, slots=True)
class AgentParts:
    """Parts of an agent; the composition root chooses each."""

    source: Source
    reader: SourceReader
    raw: SampleEncoder
    pipeline: TrackerPipeline
    wearer: WearerNotifier
    header_factory: HeaderFactory
    clock: StationClock
    black_box: BlackBox
    journal: Journal
    journal_writer: JournalWriter
    mayday_latch: MaydayLatch
    steps: StepScaleKeeper
    outbox: Outbox
    link: Link
    commands: SimpleQueue[bytes]  # filled by the link
    manager: ServiceManager
    start_check: SelfTest | None = None  # None: of an agent that has no sensors of its own
