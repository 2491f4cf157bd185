"""Composition root of the live station: builds, runs and ends it."""

from __future__ import annotations

import asyncio
import os
import secrets
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import AbstractContextManager, ExitStack
from functools import partial
from typing import NamedTuple

from base_station.api.app import create_app
from base_station.api.replays import Replays
from base_station.api.routes.forgetting import accept_from_command
from base_station.api.server import ConsoleServer, serve_until_stopped
from base_station.api.services import Services
from base_station.app.factories import (
    Announce,
    announce_first_login,
    replay_process_starter,
)
from base_station.app.folder_commands import FORGET_COMMAND, cut_log
from base_station.app.health_facts import health_facts
from base_station.app.live_fan_out import LiveFanOut
from base_station.app.older_assignments import OlderAssignments
from base_station.app.pipeline_factory import past_pipeline
from base_station.app.resources import Resources, open_station
from base_station.app.start_engine import start_drive
from base_station.app.startup_console import Watch, serve_while_recovering, startup_application
from base_station.config import StationConfig
from base_station.core.alarms import ALARMS
from base_station.core.alarms.thresholds import Thresholds, thresholds_of
from base_station.core.log_position import LogPosition
from base_station.core.state import StationState
from base_station.engine.liveness import LivenessMonitor
from base_station.engine.ports import ActionResult, EnginePorts
from base_station.engine.rate_limiter import SenderRateLimiter
from base_station.engine.sender_bans import SenderBans
from base_station.forwarders.interface import Surroundings
from base_station.forwarders.running import make_forwarders
from base_station.privacy.erasure_service import BY_OTHER_STATION
from base_station.privacy.requests import ErasureRequests
from base_station.process import gc_tuning
from base_station.process.open_files import allow_many_files
from base_station.process.shutdown_watchdog import ShutdownWatchdog
from base_station.process.thread_crash_monitor import ThreadCrashMonitor
from base_station.replay.post_processing import PostProcessor
from base_station.replay.post_processing_worker import PostProcessingWorker
from base_station.replay.processes.replay_process import ReplayContext
from base_station.replay.processes.server import ReplayProcesses
from base_station.security.pki.enrolled_units import EnrolledUnits
from base_station.site.plan_reader import PlanReader
from base_station.standby.mode import HaMode, Paired, Parts, Standalone
from base_station.standby.stale_state import StaleState
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.base_maps import BaseMaps
from base_station.storage.db.replicated_tables import ReplicatedTables
from base_station.storage.segment_index import SegmentIndex
from base_station.unit_sync.backfill import Backfill, Report
from base_station.unit_sync.clock_server import ClockServer
from base_station.unit_sync.command_sender import CommandSender, without_text_of_commands
from base_station.unit_sync.durable_ack import DurableAckGate
from base_station.unit_sync.log_gap_detector import Lost
from base_station.views.station import StationFacts
from shared.channels import ROOT, clock_key
from shared.envelope import Stamper
from shared.messages import STATION_ID
from shared.messages.station import Action, SetThresholds
from shared.service_manager import ServiceManager


class _Restart(NamedTuple):
    """The station is to start anew; where there is another one that leads, as its standby."""

    cut_from: LogPosition | None  # behind which the log goes its own way
    is_repaired: bool = False  # what was saved of it was made without what was missing


def run_station(config: StationConfig, announce: Announce) -> None:
    """The live station, until SIGINT or SIGTERM.  ``announce`` hears what a person must know.

    Raises ConfigError where no alarm rule can have the thresholds of the settings.
    """
    thresholds = thresholds_of(ALARMS, config.alarms)
    gc_tuning.configure()
    allow_many_files()
    manager = ServiceManager(os.environ)

    def tell(line: str) -> None:
        announce(line)
        manager.working()

    while (restart := _run_once(config, thresholds, tell, manager)) is not None:
        gc_tuning.unfreeze()
        if restart.cut_from is not None:
            tell("what the other station does not have is set aside, and handed to it")
            cut_log(config.data, restart.cut_from, lambda _: manager.working())
        if restart.is_repaired:
            tell("what the disk had lost of the log is there again, and is stepped")
            Checkpoints(DataFolder(config.data).checkpoints).clear()


def _run_once(
    config: StationConfig, thresholds: Thresholds, announce: Announce, manager: ServiceManager
) -> _Restart | None:
    with ShutdownWatchdog() as end, ExitStack() as closing:
        resources = open_station(config, announce, closing)
        return _Station(resources, thresholds, announce, manager, end, closing).run()


class _Station:
    """The parts that know of each other, each made behind what it needs at once.

    What it needs later it asks for then: who leads, say, of a side that hears of the drive when
    that has begun.
    """

    def __init__(
        self,
        resources: Resources,
        thresholds: Thresholds,
        announce: Announce,
        manager: ServiceManager,
        end: ShutdownWatchdog,
        closing: ExitStack,
    ) -> None:
        """Begins to hear and to step; ``closing`` ends everything in its order."""
        self._resources, self._disk = resources, resources.disk
        self._announce, self._manager, self._end = announce, manager, end
        self._restart: _Restart | None = None
        bus, steady = resources.bus, self._disk.clock
        self._stale_picture = StaleState()
        self._ended = closing.enter_context(ThreadCrashMonitor())
        self._is_in_incident: Callable[[], bool] = lambda: False  # until the log has been read
        self._reported: Mapping[str, str] = {}  # problems of the station's parts, by the log
        self._thresholds = thresholds  # of the alarm rules, by the settings
        self._thresholds_in_use: Callable[[], Thresholds] = lambda: thresholds  # by the log
        self._past = closing.enter_context(ReplayProcesses())
        self._side = self._new_side()
        self._share = SenderRateLimiter(self._side.feed.offer, steady)
        hearing = bus.subscribe(f"{ROOT}/**", without_text_of_commands(self._share.offer))
        self._bans = SenderBans(resources.router.ban, steady)
        self._links = LivenessMonitor(bus, self._bans.ban, steady)
        closing.callback(self._links.close)
        clock_server = ClockServer(steady, self._is_leader)
        closing.callback(bus.serve(clock_key("*"), clock_server.replies).close)
        self._missing_count = 0  # times that the log was found to have messages no more
        self._reports = DurableAckGate(resources.recorder)
        self._backfill = Backfill(
            bus, resources.feed.deliver, resources.clock, self._may_acknowledge
        )
        self._forwarders = make_forwarders(
            {"tak": resources.config.tak}, Surroundings(steady, self._is_leader)
        )
        self._shown = LiveFanOut(resources.hub, self._forwarders)
        stamper = Stamper(STATION_ID, secrets.randbits(63), steady)
        self._downlink = CommandSender(bus, stamper, steady, self._disk.roster.shown)
        self._forgettings = self._disk.forgetting_desk(
            resources.recordings,
            self._submit_if_leader,
            self._request_checkpoint,
            self._is_leader,
            self._has_peer,
        )
        self._plans = PlanReader()
        saved = self._disk.latest_state()
        self._stepped_from_ns = saved.t_ns if saved else 0
        self._drive = start_drive(
            self._disk.log,
            saved,
            self._engine_ports(),
            self._on_replayed,
            self._startup_console(),
            self._plans,
        )
        self._gate = self._side.gate_to(self._drive)
        # Ends behind the drive: the other station gets all.
        self._after_engine = closing.enter_context(ExitStack())
        closing.callback(self._drive.stop)
        closing.callback(hearing.close)  # first: what still comes is stepped before the end
        closing.enter_context(self._forgettings)
        for thread in (self._backfill, self._downlink):
            thread.start()
            closing.callback(thread.close)
        closing.callback(self._forwarders.close)
        self._shown.start(self._drive)
        closing.callback(self._side.feed.close)
        post_processor, records = self._disk.post_processor(self._past), self._disk.records
        closing.enter_context(
            PostProcessingWorker(post_processor, records.incidents, records.tracks_of)
        )
        self._hindsight = post_processor
        self._services = self._new_services(post_processor)
        self._server = self._new_server()

    def run(self) -> _Restart | None:
        """Serve consoles until a signal comes, or the station is to start anew."""
        self._side.start(self._gate, self._after_engine)
        asyncio.run(serve_until_stopped(self._server, self._on_ready, self._housekeeping()))
        return self._restart

    # ---- what is made

    def _new_side(self) -> HaMode:
        resources, disk = self._resources, self._disk
        parts = Parts(
            data=disk.folder.path,
            bus=resources.bus,
            log=disk.recorder,
            disk=disk.log,
            files=disk.recorder,
            check=disk.check,
            live=resources.feed,
            clock=disk.clock,
            tables=ReplicatedTables(disk.store),
            records=disk.records,
            pki=resources.pki,
            on_people=disk.roster.read_again,
            on_taken_back=disk.note_taken_back,
            on_lead=lambda: announce_first_login(
                disk.accounts,
                None if disk.store.in_memory else disk.folder.first_login,
                self._announce,
            ),
            start_again=self._request_restart,
            step_again=self._on_log_repaired,
            forget=self._erase_for_peer,
        )
        standby = resources.config.standby
        return Paired(standby, parts) if standby.name else Standalone(parts)

    def _engine_ports(self) -> EnginePorts:
        """Gives the ports of the engine."""
        return EnginePorts(
            feed=self._side.feed,
            log=self._side.log,
            live=self._shown,
            projection=self._disk.projection,
            checkpoints=self._disk.checkpoints,
            people=self._disk.roster.known,
            facts=self._facts,
            clock=self._disk.clock,
            boot_id=secrets.randbits(63),
            report=self._report,
            linked=lambda: self._links.linked,
            unlinked=lambda: self._links.unlinked,
            say=lambda orders: self._downlink.report(orders if self._side.leads else ()),
        )

    def _startup_console(self) -> AbstractContextManager[Watch]:
        resources = self._resources
        return serve_while_recovering(
            resources.recorder.segments(),
            resources.listening,
            resources.config.http,
            lambda: startup_application(resources.config, self._disk),
            self._announce,
        )

    def _new_services(self, post_processor: PostProcessor) -> Services:
        resources, disk = self._resources, self._disk
        return Services(
            accounts=disk.accounts,
            roster=disk.roster,
            records=disk.records,
            base_maps=BaseMaps(disk.store),
            hub=resources.hub,
            gate=self._gate,
            projection=disk.projection,
            replays=Replays(replay_process_starter(self._replay_place(), disk.clock.utc_ns)),
            forgettings=self._forgettings,
            clock=disk.clock,
            secure=resources.config.http.certificate is not None,
            ha_status=self._side.ha_status,
            recordings=resources.recordings,
            post_processor=post_processor,
            plans=self._plans,
            pki=resources.pki,
            accountability=resources.config.accountability,
        )

    def _replay_place(self) -> ReplayContext:
        disk = self._disk
        return ReplayContext(
            processes=self._past,
            log=str(disk.folder.log),
            checkpoints=str(disk.folder.checkpoints),
            prepare=disk.recorder.flush,
            note_damage=disk.check.recheck,
            people=disk.roster.known_people,
            empty_pipeline=lambda: past_pipeline(None),
            known_segments=disk.known_segments,
        )

    def _new_server(self) -> ConsoleServer:
        hub, http = self._resources.hub, self._resources.config.http
        app = create_app(self._services, started=lambda loop: hub.connect(loop, self._drive))
        return ConsoleServer(
            app,
            self._resources.listening,
            http.certificate,
            http.private_key,
            on_stop=self._on_stop,
            is_known=app.state.known_networks.__contains__,
        )

    def _housekeeping(self) -> Callable[[], None]:
        resources, records = self._resources, self._disk.records
        recoveries = {one.path: str(one) for one in resources.recorder.recoveries}
        index = SegmentIndex(records, recoveries, lambda: self._disk.check.lacking)
        enrolled = EnrolledUnits(
            resources.pki, self._gate, self._disk.roster.registered_units, records
        )

        lost = self._disk.lost_from_log(self._mark_missing)
        older = OlderAssignments(self._disk.roster, self._gate)
        requests = ErasureRequests(
            self._disk.folder,
            partial(accept_from_command, self._services, FORGET_COMMAND),
        )

        def run_housekeeping() -> None:
            index.update(resources.recorder.segments())
            self._disk.check.look(resources.recorder.segments())
            if not resources.config.standby.name:  # else it comes from the other station
                lost.look()
            self._restart_if_stale()
            requests.look()
            resources.presence.update()
            self._past.end_idle()
            if resources.renewal.is_due(in_incident=self._is_in_incident()):
                self._announce("the renewed certificate is taken up")
                self._request_restart(None)
            if self._side.leads:
                enrolled.update()
                older.look()
                if self._thresholds_in_use() != self._thresholds:
                    self._gate.submit(STATION_ID, SetThresholds(self._thresholds))
                for monitor in (self._share, self._backfill.share, self._bans, self._forwarders):
                    for report in monitor.changes(self._reported):
                        self._gate.submit(STATION_ID, report)

        return run_housekeeping

    # ---- what they ask and tell each other

    def _on_replayed(self, place: tuple[int, int], state: StationState) -> None:
        """Takes the state that the log gives, before the engine runs."""

        def is_in_incident() -> bool:
            incident = state.incident
            return incident is not None and incident.closed_ns is None

        self._is_in_incident = is_in_incident
        self._reported = state.problems
        self._thresholds_in_use = lambda: state.thresholds
        self._stale_picture.note_stepped(self._stepped_from_ns, place[0])
        self._disk.clock.hold_while(lambda: not self._is_leader() or is_in_incident())
        self._side.begin(place, state)

    def _is_leader(self) -> bool:
        return self._side.leads

    def _has_peer(self) -> bool:
        ha_status = self._side.ha_status
        return ha_status is not None and ha_status.view().other_role != ""

    def _request_restart(self, cut_from: LogPosition | None) -> None:
        self._restart = self._restart or _Restart(cut_from, self._stale_picture.is_stale)
        self._server.stop()

    def _on_stop(self) -> None:
        resources = self._resources
        self._hindsight.close()  # who waits for what it works out would keep the station
        self._end.begin(lambda: resources.recorder.not_kept, resources.router.close)

    def _on_log_repaired(self, end_ns: int) -> None:
        self._stale_picture.note_mended(end_ns)
        self._restart_if_stale()

    def _restart_if_stale(self) -> None:
        ha_status = self._side.ha_status
        has_standby = ha_status is not None and ha_status.view().in_step
        in_incident = self._is_in_incident()
        if self._stale_picture.can_be_made_good(
            leads=self._is_leader(), spared=has_standby, in_incident=in_incident
        ):
            self._request_restart(None)

    def _may_acknowledge(self) -> bool:
        return self._side.may_forget() and self._reports.previous_report_is_durable()

    def _submit_if_leader(self, by: str, action: Action) -> Future[ActionResult] | None:
        """A standby does what stands in the other's log."""
        return self._drive.submit(by, action) if self._side.leads else None

    def _request_checkpoint(self) -> None:
        self._drive.save_soon()

    def _report(self, held: Report, in_memory: bool) -> None:
        self._side.note_report()
        self._reports.note_report_received()
        refused = self._resources.recorder.lost + self._missing_count
        self._backfill.report(held, refused, alerts_only=in_memory)

    def _mark_missing(self, lost: Lost) -> None:
        self._drive.mark_missing(lost)
        self._missing_count += 1

    def _erase_for_peer(self, what: str) -> None:
        """The other station has forgotten this, and of who it is this one's log tells, too."""
        kind, _, one = what.partition(" ")
        self._forgettings.add(BY_OTHER_STATION, kind, one, told=True)

    def _facts(self) -> StationFacts:
        """The drive asks once a second, with a full disk and at a standby too; hanging, it does
        not, and the service manager hears of it.
        """
        self._manager.working()
        others = (self._forgettings, self._disk.check, self._stale_picture, self._ended)
        return health_facts(
            self._resources,
            self._disk.clock,
            self._side,
            others,
            missing=self._backfill.gone,
            forwarders=self._forwarders.views(),
        )

    def _on_ready(self, line: str) -> None:
        """Consoles can connect."""
        self._announce(line)
        self._manager.ready()
