"""Puts the live station together from its parts, runs it, and takes it apart."""

from __future__ import annotations

import asyncio
import os
import secrets
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import AbstractContextManager, ExitStack
from typing import NamedTuple

from base_station.alarms import ALARMS
from base_station.alarms.thresholds import Thresholds, thresholds_of
from base_station.api.app import create_app
from base_station.api.replays import Replays
from base_station.api.server import ConsoleServer, allow_many_files, serve_until_stopped
from base_station.api.services import Services
from base_station.app.early_console import early_console
from base_station.app.facts import facts_of
from base_station.app.folder import cut_log
from base_station.app.parts import (
    Announce,
    announce_first_login,
    replay_starter,
)
from base_station.app.resources import Resources, open_station
from base_station.app.start_drive import start_drive
from base_station.clocks.server import ClockServer
from base_station.commands.downlink import Downlink
from base_station.config import StationConfig
from base_station.db.base_maps import BaseMaps
from base_station.db.replicated_tables import ReplicatedTables
from base_station.forgetting.forgetter import BY_OTHER_STATION
from base_station.journals.backfill import Backfill, Report
from base_station.journals.lost_from_log import Lost
from base_station.journals.on_disk import ReportsOnDisk
from base_station.live.drive_ports import DrivePorts
from base_station.live.fair_share import FairShare
from base_station.live.linked_units import LinkedUnits
from base_station.live.recovering import Watch, recovering
from base_station.live.sinks import ActionDone
from base_station.live_state import StationState
from base_station.past.checkpoints import Checkpoints
from base_station.past.hindsight import Hindsight
from base_station.past.looking_back import LookingBack
from base_station.pki.members import EnrolledUnits
from base_station.program import interpreter
from base_station.program.end_in_time import EndInTime
from base_station.program.ended_threads import EndedThreads
from base_station.standby.places import Place
from base_station.standby.side import OneOfTwo, OnlyStation, Parts, Side
from base_station.standby.stale_picture import StalePicture
from base_station.storage.data_folder import DataFolder
from base_station.storage.segment_index import SegmentIndex
from base_station.views.station import StationFacts
from shared.channels import ROOT, clock_key
from shared.envelope import Stamper
from shared.messages import STATION_ID
from shared.messages.station import Action, SetThresholds
from shared.service_manager import ServiceManager


class _Again(NamedTuple):
    """The station is to start anew; where there is another one that leads, as its standby."""

    cut: Place | None  # behind which the log goes its own way
    mended: bool = False  # what was saved of it was made without what was missing


def run_station(config: StationConfig, announce: Announce) -> None:
    """The live station, until SIGINT or SIGTERM.  ``announce`` hears what a person must know.

    Raises ConfigError where no alarm rule can have the thresholds of the settings.
    """
    thresholds = thresholds_of(ALARMS, config.alarms)
    interpreter.relax()
    allow_many_files()
    manager = ServiceManager(os.environ)

    def tell(line: str) -> None:
        announce(line)
        manager.working()

    while (again := _run_once(config, thresholds, tell, manager)) is not None:
        if again.cut is not None:
            tell("what the other station does not have is set aside, and handed to it")
            cut_log(config.data, again.cut, lambda _: manager.working())
        if again.mended:
            tell("what the disk had lost of the log is there again, and is stepped")
            Checkpoints(DataFolder(config.data).checkpoints).clear()


def _run_once(
    config: StationConfig, thresholds: Thresholds, announce: Announce, manager: ServiceManager
) -> _Again | None:
    with EndInTime() as end, ExitStack() as closing:
        resources = open_station(config, announce, closing)
        return _LiveStation(resources, thresholds, announce, manager, end, closing).run()


class _LiveStation:
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
        end: EndInTime,
        closing: ExitStack,
    ) -> None:
        """Begins to hear and to step; ``closing`` ends everything in its order."""
        self._resources, self._disk = resources, resources.disk
        self._announce, self._manager, self._end = announce, manager, end
        self._again: _Again | None = None
        bus, steady = resources.bus, self._disk.clock
        self._stale_picture = StalePicture()
        self._ended = closing.enter_context(EndedThreads())
        self._is_in_incident: Callable[[], bool] = lambda: False  # until the log has been read
        self._reported: Mapping[str, str] = {}  # problems of the station's parts, by the log
        self._thresholds = thresholds  # of the alarm rules, by the settings
        self._thresholds_in_use: Callable[[], Thresholds] = lambda: thresholds  # by the log
        self._side = self._new_side()
        self._share = FairShare(self._side.feed.offer, steady)
        hearing = bus.subscribe(f"{ROOT}/**", self._share.offer)
        self._links = LinkedUnits(bus)
        closing.callback(self._links.close)
        clock_server = ClockServer(steady, self._leads)
        closing.callback(bus.serve(clock_key("*"), clock_server.replies).close)
        self._taken_back = 0  # times that the log was found to have messages no more
        self._reports = ReportsOnDisk(resources.recorder)
        self._backfill = Backfill(bus, resources.feed.deliver, resources.clock, self._may_forget)
        stamper = Stamper(STATION_ID, secrets.randbits(63), steady)
        self._downlink = Downlink(bus, stamper, steady)
        self._forgettings = self._disk.forgetting_desk(
            resources.recordings, self._act, self._save_soon, self._leads, self._other_there
        )
        saved = self._disk.archive.latest()
        self._stepped_from_ns = saved.t_ns if saved else 0
        self._drive = start_drive(
            self._disk.log, saved, self._drive_ports(), self._begin, self._recovering()
        )
        self._gate = self._side.gate_to(self._drive)
        # Ends behind the drive: the other station gets all.
        self._beside = closing.enter_context(ExitStack())
        closing.callback(self._drive.stop)
        closing.callback(hearing.close)  # first: what still comes is stepped before the end
        closing.enter_context(self._forgettings)
        for thread in (self._backfill, self._downlink):
            thread.start()
            closing.callback(thread.close)
        closing.callback(self._side.feed.close)
        hindsight, records = self._disk.hindsight(), self._disk.records
        closing.enter_context(LookingBack(hindsight, records.incidents, records.tracks_of))
        self._services = self._new_services(hindsight)
        self._server = self._new_server()

    def run(self) -> _Again | None:
        """Serve consoles until a signal comes, or the station is to start anew."""
        self._side.start(self._gate, self._beside)
        asyncio.run(serve_until_stopped(self._server, self._ready, self._housekeeping()))
        return self._again

    # ---- what is made

    def _new_side(self) -> Side:
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
            on_lead=lambda: announce_first_login(
                disk.accounts, disk.folder.first_login, self._announce
            ),
            start_again=self._start_again,
            step_again=self._step_again,
            forget=self._forget,
        )
        standby = resources.config.standby
        return OneOfTwo(standby, parts) if standby.name else OnlyStation(parts)

    def _drive_ports(self) -> DrivePorts:
        """Of the drive."""
        return DrivePorts(
            feed=self._side.feed,
            log=self._side.log,
            live=self._resources.hub,
            projection=self._disk.projection,
            checkpoints=self._disk.checkpoints,
            photo_urls=self._disk.roster.photo_url,
            facts=self._facts,
            clock=self._disk.clock,
            boot_id=secrets.randbits(63),
            report=self._report,
            linked=lambda: self._links.linked,
            unlinked=lambda: self._links.unlinked,
            say=lambda orders: self._downlink.report(orders if self._side.leads else ()),
        )

    def _recovering(self) -> AbstractContextManager[Watch]:
        resources = self._resources
        return recovering(
            resources.recorder.segments(),
            resources.listening,
            resources.config.http,
            lambda: early_console(resources.config, self._disk),
            self._announce,
        )

    def _new_services(self, hindsight: Hindsight) -> Services:
        resources, disk = self._resources, self._disk
        return Services(
            accounts=disk.accounts,
            roster=disk.roster,
            records=disk.records,
            base_maps=BaseMaps(disk.store),
            hub=resources.hub,
            gate=self._gate,
            settle=disk.projection.flush,
            replays=Replays(
                replay_starter(disk.archive, disk.roster, disk.clock, disk.clock.utc_ns)
            ),
            forgettings=self._forgettings,
            clock=disk.clock,
            secure=resources.config.http.certificate is not None,
            standing=self._side.standing,
            recordings=resources.recordings,
            hindsight=hindsight,
            accountability=resources.config.accountability,
        )

    def _new_server(self) -> ConsoleServer:
        hub, http = self._resources.hub, self._resources.config.http
        app = create_app(self._services, started=lambda loop: hub.connect(loop, self._drive))
        return ConsoleServer(
            app,
            self._resources.listening,
            http.certificate,
            http.private_key,
            on_stop=self._ends,
        )

    def _housekeeping(self) -> Callable[[], None]:
        resources, records = self._resources, self._disk.records
        recoveries = {one.path: str(one) for one in resources.recorder.recoveries}
        index = SegmentIndex(records, recoveries)
        enrolled = EnrolledUnits(
            resources.pki, self._gate, self._disk.roster.registered_units, records
        )

        lost = self._disk.lost_from_log(self._take_back)

        def keep_house() -> None:
            index.update(resources.recorder.segments())
            self._disk.check.look(resources.recorder.segments())
            if not resources.config.standby.name:  # else it comes from the other station
                lost.look()
            self._make_good()
            if resources.renewal.is_due(in_incident=self._is_in_incident()):
                self._announce("the renewed certificate is taken up")
                self._start_again(None)
            if self._side.leads:
                enrolled.update()
                if self._thresholds_in_use() != self._thresholds:
                    self._gate.submit(STATION_ID, SetThresholds(self._thresholds))
                for report in self._share.news(self._reported):
                    self._gate.submit(STATION_ID, report)

        return keep_house

    # ---- what they ask and tell each other

    def _begin(self, place: tuple[int, int], state: StationState) -> None:
        """What the log says, before the drive runs."""

        def is_in_incident() -> bool:
            incident = state.incident
            return incident is not None and incident.closed_ns is None

        self._is_in_incident = is_in_incident
        self._reported = state.problems
        self._thresholds_in_use = lambda: state.thresholds
        self._stale_picture.note_stepped(self._stepped_from_ns, place[0])
        self._disk.clock.hold_while(lambda: not self._leads() or is_in_incident())
        self._side.begin(place, state)

    def _leads(self) -> bool:
        return self._side.leads

    def _other_there(self) -> bool:
        standing = self._side.standing
        return standing is not None and standing.view().other_role != ""

    def _start_again(self, cut: Place | None) -> None:
        self._again = self._again or _Again(cut, self._stale_picture.is_so)
        self._server.stop()

    def _ends(self) -> None:
        resources = self._resources
        self._end.begin(lambda: resources.recorder.not_kept, resources.router.close)

    def _step_again(self, end_ns: int) -> None:
        self._stale_picture.note_mended(end_ns)
        self._make_good()

    def _make_good(self) -> None:
        standing = self._side.standing
        spared = standing is not None and standing.view().in_step
        in_incident = self._is_in_incident()
        if self._stale_picture.can_be_made_good(
            leads=self._leads(), spared=spared, in_incident=in_incident
        ):
            self._start_again(None)

    def _may_forget(self) -> bool:
        return self._side.may_forget() and self._reports.has_report_before()

    def _act(self, by: str, action: Action) -> Future[ActionDone] | None:
        """A standby does what stands in the other's log."""
        return self._drive.submit(by, action) if self._side.leads else None

    def _save_soon(self) -> None:
        self._drive.save_soon()

    def _report(self, held: Report, in_memory: bool) -> None:
        self._side.note_report()
        self._reports.report_comes()
        refused = self._resources.recorder.lost + self._taken_back
        self._backfill.report(held, refused, alerts_only=in_memory)

    def _take_back(self, lost: Lost) -> None:
        self._drive.take_back(lost)
        self._taken_back += 1

    def _forget(self, what: str) -> None:
        """The other station has forgotten this, and of who it is this one's log tells, too."""
        kind, _, one = what.partition(" ")
        self._forgettings.add(BY_OTHER_STATION, kind, one, told=True)

    def _facts(self) -> StationFacts:
        """The drive asks once a second, with a full disk and at a standby too; hanging, it does
        not, and the service manager hears of it.
        """
        self._manager.working()
        others = (self._forgettings, self._disk.check, self._stale_picture, self._ended)
        return facts_of(self._resources, self._disk.clock, self._side, others)

    def _ready(self, line: str) -> None:
        """Consoles can connect."""
        self._announce(line)
        self._manager.ready()
