"""Live station: builds its parts, connects them, and runs until a signal or a restart."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager, ExitStack

from base_station.api.server import serve_until_stopped
from base_station.app.archiving import automatic_archive
from base_station.app.catch_up import CatchUp
from base_station.app.factories import Announce, announce_first_login
from base_station.app.health_facts import health_facts
from base_station.app.housekeeping import Housekeeping
from base_station.app.live_console import new_server, new_services
from base_station.app.live_fan_out import LiveFanOut, ProjectionFanOut
from base_station.app.live_parts import LiveParts
from base_station.app.live_state import LiveState
from base_station.app.resources import Resources
from base_station.app.restart_control import Restart, RestartControl
from base_station.app.start_engine import start_engine
from base_station.app.startup_console import Watch, serve_while_recovering, startup_application
from base_station.app.unit_reports import UnitReports
from base_station.archive.outdated_copies import OutdatedCopies
from base_station.core.alarms.thresholds import Thresholds
from base_station.core.state import StationState
from base_station.core.state.command import Order
from base_station.engine.engine import StationEngine
from base_station.engine.liveness import LivenessMonitor
from base_station.engine.ports import ActionResult, EnginePorts
from base_station.engine.rate_limiter import SenderRateLimiter
from base_station.engine.sender_bans import SenderBans
from base_station.forwarders.interface import Surroundings
from base_station.forwarders.running import Forwarders, make_forwarders
from base_station.privacy.erasure_queue import ErasureQueue
from base_station.privacy.erasure_service import BY_OTHER_STATION
from base_station.process.shutdown_watchdog import ShutdownWatchdog
from base_station.process.thread_crash_monitor import ThreadCrashMonitor
from base_station.radio.radio_log import RadioLog
from base_station.radio.recorders import RadioRecorders
from base_station.replay.post_processing_worker import PostProcessingWorker
from base_station.replay.processes.server import ReplayProcesses
from base_station.site.plan_reader import PlanReader
from base_station.standby.leader_requests import LeaderRequests, WaitingErasure
from base_station.standby.mode import HaMode, Paired, Parts, Standalone
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.replicated_tables import ReplicatedTables
from base_station.storage.db.unfinished_erasures import UnfinishedErasures
from base_station.storage.segment_packer import SegmentPacker
from base_station.unit_sync.clock_server import ClockServer
from base_station.unit_sync.command_sender import CommandSender, without_text_of_commands
from base_station.views.station import StationFacts
from base_station.views.wire import ArchiveView
from shared.bus import Subscription
from shared.channels import ROOT, clock_key
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, ExternalMarker
from shared.messages.station import Action
from shared.service_manager import ServiceManager


class RunningStation:
    """Parts of a station that depend on each other, in the order in which they are built.

    A part that depends on a later one receives a function of this class instead of the part:
    ``_is_leader``, for example, is passed on before the HA mode exists.
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
        """Start to receive and process messages; ``closing`` closes the parts in reverse order."""
        self._resources, self._disk = resources, resources.disk
        self._announce, self._manager, self._watchdog = announce, manager, end
        self._closing = closing
        self._live = LiveState(thresholds, resources.config.positioning.fuser)
        self._restarts = RestartControl(
            self._stop_server,
            is_leader=self._is_leader,
            has_standby=self._has_standby,
            is_in_incident=self._live.is_in_incident,
        )
        self._crashes = closing.enter_context(ThreadCrashMonitor())
        self._replays = closing.enter_context(ReplayProcesses())
        self._ha_mode = self._new_ha_mode()
        self._limiter = SenderRateLimiter(self._ha_mode.feed.offer, self._disk.clock)
        self._bans = SenderBans(resources.router.ban, self._disk.clock)
        subscription = self._open_bus()
        self._reports = UnitReports(resources, self._ha_mode)
        self._forwarders = self._new_forwarders()
        self._fan_out = LiveFanOut(resources.hub, self._forwarders)
        self._command_sender = self._new_command_sender()
        self._archive = automatic_archive(resources, self._replays, self._is_leader)
        self._outdated_copies = OutdatedCopies(
            ArchivedCopies(self._disk.store), self._archive_view, self._is_leader
        )
        self._radio = self._new_radio()
        self._erasures = self._new_erasure_queue()
        self._plans = PlanReader()
        self._engine = self._start_engine()
        self._gate = self._ha_mode.gate_to(self._engine)
        # Closed after the engine has stopped: the other station receives all that the engine wrote.
        self._after_engine = closing.enter_context(ExitStack())
        closing.callback(self._engine.stop)
        # Closed before the engine stops, which processes all that was received until then.
        closing.callback(subscription.close)
        self._start_exchange()
        self._post_processor = self._disk.post_processor(self._replays)
        self._start_work_on_log()
        self._parts = self._live_parts()
        self._services = new_services(self._parts)
        self._server = new_server(self._parts, self._services, self._on_stop)

    def run(self) -> Restart | None:
        """Serve consoles until a signal; return the restart that was requested, if any."""
        self._ha_mode.start(self._gate, self._after_engine)
        housekeeping = Housekeeping(self._parts, self._services)
        asyncio.run(serve_until_stopped(self._server, self._on_ready, housekeeping.run))
        housekeeping.list_segments()  # those since its last round may be lost until the next start
        return self._restarts.requested

    # ---- construction of the parts

    def _new_ha_mode(self) -> HaMode:
        resources, disk = self._resources, self._disk
        unfinished = UnfinishedErasures(disk.store)
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
            on_restored_rows=disk.note_restored_rows,
            on_lead=lambda: announce_first_login(
                disk.accounts,
                None if disk.store.in_memory else disk.folder.first_login,
                self._announce,
            ),
            start_again=self._restarts.request,
            step_again=self._restarts.note_repaired,
            erasures=self._waiting_erasures,
            unfinished_erasures=unfinished.find,
            orphaned_erasures=unfinished.find_orphaned,
            leader_requests=LeaderRequests(disk.folder.leader_requests),
            forget=self._erase_for_peer,
        )
        standby = resources.config.standby
        return Paired(standby, parts) if standby.name else Standalone(parts)

    def _open_bus(self) -> Subscription:
        """Start to receive from units, and to answer their clock queries."""
        bus, clock = self._resources.bus, self._disk.clock
        subscription = bus.subscribe(f"{ROOT}/**", without_text_of_commands(self._limiter.offer))
        self._links = LivenessMonitor(bus, self._bans.ban, clock)
        self._closing.callback(self._links.close)
        clock_server = ClockServer(clock, self._is_leader)
        self._closing.callback(bus.serve(clock_key("*"), clock_server.replies).close)
        return subscription

    def _new_forwarders(self) -> Forwarders:
        return make_forwarders(
            self._resources.config.forwarders(),
            Surroundings(
                clock=self._disk.clock,
                leads=self._is_leader,
                data=self._disk.folder.path,
                people=self._disk.roster.known,
                read_log=self._disk.log.records,
                note_external=self._note_external,
            ),
        )

    def _new_command_sender(self) -> CommandSender:
        clock = self._disk.clock
        header_factory = HeaderFactory(STATION_ID, secrets.randbits(63), clock)
        return CommandSender(self._resources.bus, header_factory, clock, self._disk.roster.shown)

    def _new_radio(self) -> RadioRecorders:
        return RadioRecorders(
            self._resources.config.radio,
            RadioLog(self._disk.folder.radio),
            self._disk.clock,
            self._keeps_audio_since_ns,
        )

    def _new_erasure_queue(self) -> ErasureQueue:
        return self._disk.erasure_queue(
            self._resources.recordings,
            self._submit_if_leader,
            self._request_checkpoint,
            self._is_leader,
            self._has_peer,
            self._radio.erase,
        )

    def _start_engine(self) -> StationEngine:
        saved = self._disk.latest_state()
        self._applied_from_ns = saved.t_ns if saved else 0
        return start_engine(
            self._disk.log,
            saved,
            self._engine_ports(),
            self._on_replayed,
            self._startup_console(),
            self._plans,
        )

    def _start_exchange(self) -> None:
        """Start erasures, backfill, commands, forwarders, radio and consoles."""
        closing = self._closing
        closing.enter_context(self._erasures)
        for thread in (self._reports.backfill, self._command_sender):
            thread.start()
            closing.callback(thread.close)
        closing.callback(self._forwarders.close)
        self._radio.start()
        closing.callback(self._radio.close)
        self._fan_out.start(self._engine)
        closing.callback(self._ha_mode.feed.close)

    def _start_work_on_log(self) -> None:
        """Start the work on the log: post-processing, catch-up of the database, the archive, and
        packing.
        """
        disk, closing = self._disk, self._closing
        records = disk.records
        closing.enter_context(
            PostProcessingWorker(self._post_processor, records.incidents, records.tracks_of)
        )
        prepare = disk.recorder.flush
        closing.enter_context(CatchUp(disk.folder, self._replays, disk.projection, prepare))
        if self._archive is not None:
            closing.enter_context(self._archive)
        closing.enter_context(SegmentPacker(disk.recorder))

    def _live_parts(self) -> LiveParts:
        return LiveParts(
            resources=self._resources,
            announce=self._announce,
            live=self._live,
            restarts=self._restarts,
            ha_mode=self._ha_mode,
            limiter=self._limiter,
            bans=self._bans,
            forwarders=self._forwarders,
            reports=self._reports,
            engine=self._engine,
            gate=self._gate,
            erasures=self._erasures,
            outdated_copies=self._outdated_copies,
            plans=self._plans,
            replays=self._replays,
            post_processor=self._post_processor,
        )

    def _engine_ports(self) -> EnginePorts:
        return EnginePorts(
            feed=self._ha_mode.feed,
            log=self._ha_mode.log,
            live=self._fan_out,
            projection=ProjectionFanOut(self._disk.projection, self._forwarders),
            checkpoints=self._disk.checkpoints,
            people=self._disk.roster.known,
            facts=self._facts,
            clock=self._disk.clock,
            boot_id=secrets.randbits(63),
            report=self._reports.report,
            linked=lambda: self._links.linked,
            unlinked=lambda: self._links.unlinked,
            send_orders=self._send_orders,
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

    # ---- callbacks between the parts

    def _on_replayed(self, place: tuple[int, int], state: StationState) -> None:
        """Receive the state that was replayed from the log, before the engine runs."""
        self._live.begin(state)
        self._restarts.stale.note_stepped(self._applied_from_ns, place[0])
        self._disk.clock.hold_while(lambda: not self._is_leader() or self._live.is_in_incident())
        self._ha_mode.begin(place, state)

    def _stop_server(self) -> None:
        self._server.stop()

    def _on_ready(self, line: str) -> None:
        """Report that consoles can connect."""
        self._announce(line)
        self._manager.ready()

    def _on_stop(self) -> None:
        resources = self._resources
        self._post_processor.close()  # a request that waits for a result would delay the stop
        self._watchdog.begin(lambda: resources.recorder.unsaved_loss, resources.router.close)

    def _facts(self) -> StationFacts:
        """Health of the station, read by the engine once a second.

        Each call is also the sign of life for the service manager: an engine that hangs makes none,
        while a full disk or the role of a standby does not stop them.
        """
        self._manager.working()
        others = (
            *(self._erasures, self._disk.check, self._restarts.stale, self._crashes),
            self._radio,
            self._outdated_copies,
            *(() if self._archive is None else (self._archive,)),
        )
        return health_facts(
            self._resources,
            self._disk.clock,
            self._ha_mode,
            others,
            missing=self._reports.backfill.gone,
            forwarders=self._forwarders.views(),
            radio=self._radio.views(),
            archive=self._archive_view(),
        )

    def _archive_view(self) -> ArchiveView | None:
        return None if self._archive is None else self._archive.view()

    def _keeps_audio_since_ns(self) -> int | None:
        return None if self._archive is None else self._archive.keeps_audio_since_ns()

    def _is_leader(self) -> bool:
        return self._ha_mode.leads

    def _has_peer(self) -> bool:
        ha_status = self._ha_mode.ha_status
        return ha_status is not None and ha_status.view().other_role != ""

    def _has_standby(self) -> bool:
        ha_status = self._ha_mode.ha_status
        return ha_status is not None and ha_status.view().in_step

    def _submit_if_leader(self, by: str, action: Action) -> Future[ActionResult] | None:
        """Submit an action; None at a standby, which receives actions by the leader's log."""
        return self._engine.submit(by, action) if self._ha_mode.leads else None

    def _note_external(self, markers: tuple[ExternalMarker, ...], removed: tuple[str, ...]) -> None:
        self._engine.note_external(markers, removed)

    def _send_orders(self, orders: Sequence[Order]) -> None:
        """Send unanswered orders to units; a standby sends none."""
        self._command_sender.report(orders if self._ha_mode.leads else ())

    def _request_checkpoint(self) -> None:
        self._engine.save_soon()

    def _waiting_erasures(self) -> list[WaitingErasure]:
        """Erasures requested at this station and not done; of a standby the leader takes them."""
        return [
            WaitingErasure(one.forgetting_id, one.kind, one.subject_id)
            for one in self._erasures.own_waiting()
        ]

    def _erase_for_peer(self, subject: str) -> None:
        """Erase a person or incident that the other station has erased, from this log too.

        ``subject``: "person ID" or "incident ID".
        """
        kind, _, subject_id = subject.partition(" ")
        self._erasures.add(BY_OTHER_STATION, kind, subject_id, from_peer=True)
