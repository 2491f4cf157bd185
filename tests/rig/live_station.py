"""A live station in a test: the real feed, recorder, drive and pipeline on a memory bus."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Self

from base_station.core.alarms import ALARMS
from base_station.core.checkpoint import Checkpoint
from base_station.core.pipeline import StationPipeline
from base_station.engine.engine import StationEngine
from base_station.engine.feed import LiveFeed
from base_station.engine.liveness import LivenessMonitor
from base_station.engine.log_feed import FolderFeed
from base_station.engine.ports import ActionResult, EnginePorts, Feed, Log, Trails
from base_station.engine.station_clock import SteadyClock
from base_station.fusion import FUSERS
from base_station.replay.playback import Archive
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.known_people import KnownPerson, person_lookup
from base_station.storage.projection import Projection
from base_station.storage.recorder import Recorder
from base_station.unit_sync.backfill import Report
from base_station.unit_sync.command_sender import CommandSender, without_text_of_commands
from base_station.views.station import StationFacts
from base_station.views.wire import Delta, Snapshot
from shared.bus_memory import MemoryRouter
from shared.channels import channel_of
from shared.clock import Clock, SystemClock
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.mcap_log import SegmentPolicy
from shared.messages import STATION_ID, Message
from shared.messages.station import Action
from tests.rig.waiting import PATIENCE_S


def make_pipeline(checkpoint: Checkpoint | None = None) -> StationPipeline:
    return StationPipeline(ALARMS, FUSERS[0], checkpoint)


class Screen:
    """A ``LiveSink`` that remembers everything."""

    def __init__(self) -> None:
        self.deltas: list[Delta] = []
        self.resets: list[Snapshot] = []

    def delta(self, delta: Delta) -> None:
        self.deltas.append(delta)

    def reset(self, snapshot: Snapshot, _trails: Trails) -> None:
        self.resets.append(snapshot)


class Store:
    """A ``ProjectionSink`` that remembers everything, and fails on demand."""

    def __init__(self) -> None:
        self.projections: list[Projection] = []
        self.trouble = ""

    def project(self, projection: Projection) -> None:
        self.projections.append(projection)

    def problem(self) -> str:
        return self.trouble


def ports_of(feed: Feed, log: Log, screen: Screen, folder: Path, clock: Clock) -> EnginePorts:
    """Ports of an engine without checks of its surroundings."""
    return EnginePorts(
        feed=feed,
        log=log,
        live=screen,
        projection=Store(),
        checkpoints=Checkpoints(folder),
        people=person_lookup({}),
        facts=StationFacts,
        report=lambda *_: None,
        linked=frozenset,
        unlinked=frozenset,
        send_orders=lambda _: None,
        clock=clock,
        boot_id=1,
    )


class LiveStation:
    """Runs from ``with`` to its end; made again on the same folder it goes on."""

    def __init__(
        self, folder: Path, policy: SegmentPolicy | None = None, screen: Screen | None = None
    ) -> None:
        clock = SteadyClock(SystemClock())
        self.screen, self.store = screen or Screen(), Store()
        self.checkpoints = Checkpoints(folder / "checkpoints")
        self.recorder = Recorder(folder, clock, policy)
        self.reported: Report = {}  # what may be acknowledged
        self.reported_unsafe: Report = {}  # what may be in memory only
        self.feed = LiveFeed(clock)
        self.log = FolderFeed(self.recorder.folder, self.recorder.flush)
        self.router = MemoryRouter()
        self.bus = self.router.attach_station()
        self._subscription = self.bus.subscribe(
            "muster/v1/**", without_text_of_commands(self.feed.offer)
        )
        self._links = LivenessMonitor(self.bus, lambda *_: None, clock)
        header_factory = HeaderFactory(STATION_ID, clock.utc_ns(), clock)
        self.downlink = CommandSender(self.bus, header_factory, clock)
        saved = self.archive().latest()
        self.pipeline = make_pipeline(saved.pipeline if saved else None)
        self.drive = StationEngine(
            self.pipeline,
            EnginePorts(
                feed=self.feed,
                log=self.recorder,
                live=self.screen,
                projection=self.store,
                checkpoints=self.checkpoints,
                people=lambda one: KnownPerson(f"person {one}", photo_url=f"/photos/{one}"),
                facts=StationFacts,
                report=self._note_report,
                linked=lambda: self._links.linked,
                unlinked=lambda: self._links.unlinked,
                send_orders=self.downlink.report,
                clock=clock,
                boot_id=clock.utc_ns(),
            ),
        )
        after = (saved.t_ns, saved.events_at_t) if saved else (0, 0)
        self.rebuilt = self.drive.rebuild(self.log.records(after[0]), after)

    def _note_report(self, report: Report, in_memory: bool) -> None:
        if in_memory:
            self.reported_unsafe = report
        else:
            self.reported = report

    def __enter__(self) -> Self:
        self.drive.start()
        self.downlink.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.downlink.close()
        self.drive.stop()
        self.close()

    def close(self) -> None:
        self._subscription.close()
        self._links.close()
        self.recorder.close()

    def act(self, action: Action, by: str = "chief", action_id: str = "") -> ActionResult:
        return self.drive.submit(by, action, action_id).result(PATIENCE_S)

    def publish(self, message: Message) -> None:
        channel = channel_of(message)
        self.bus.publish(channel.key(message.header.unit_id), encode(message), channel.qos)

    def snapshot(self) -> Snapshot:
        found: list[Snapshot] = []
        came = threading.Event()

        def take(snapshot: Snapshot, _: Trails) -> None:
            found.append(snapshot)
            came.set()

        self.drive.request_snapshot(take)
        assert came.wait(PATIENCE_S), "no snapshot came"
        return found[0]

    def archive(self) -> Archive:
        return Archive(self.log.records, self.checkpoints, make_pipeline)
