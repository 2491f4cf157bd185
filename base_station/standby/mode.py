"""A station stands alone or is one of two; the composition root sees no difference."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from typing import Protocol

from base_station.api.ha_status import HaStatus
from base_station.config import StandbyConfig
from base_station.core.log_position import LogPosition
from base_station.core.state import StationState
from base_station.engine.feed import LiveFeed
from base_station.engine.log_feed import LogFeed
from base_station.engine.ports import EngineGate, Feed, Log
from base_station.engine.station_clock import SteadyClock
from base_station.security.pki.folder import PkiFolder
from base_station.standby.branch_merge import BranchMerge, PartServer
from base_station.standby.erasure_handover import (
    ErasureHandover,
    ErasureServer,
)
from base_station.standby.ha_controller import HaController, HaDependencies
from base_station.standby.leader_requests import LeaderRequests, WaitingErasure
from base_station.standby.log_repair import EventServer, LogRepair, SharedLogFiles
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from base_station.standby.sync_ack import LeaderOnlyGate
from base_station.standby.table_replication import TableReplication, TableServer
from base_station.storage.db.records import Records
from base_station.storage.db.replicated_tables import ReplicatedTables
from base_station.storage.db.unfinished_erasures import UnfinishedErasure
from base_station.storage.integrity_checker import IntegrityChecker
from shared.bus import Bus
from shared.messages import STATION_ID
from shared.worker import Worker


@dataclass(frozen=True)
class Parts:
    """Parts of the rest of the station."""

    data: Path
    bus: Bus
    log: Log
    disk: LogFeed
    files: SharedLogFiles
    check: IntegrityChecker
    live: LiveFeed
    clock: SteadyClock
    tables: ReplicatedTables
    records: Records
    pki: PkiFolder
    on_people: Callable[[], None]  # people or photos may have changed
    on_restored_rows: Callable[[str], None]  # rows that were lost with the database are there again
    on_lead: Callable[[], None]
    start_again: Callable[[LogPosition | None], None]
    step_again: Callable[[int], None]  # the log up to this time, in which something was missing
    erasures: Callable[[], Iterable[WaitingErasure]]  # requested here, and not done
    # Ordered by a former leader that has not reported that they are done.
    unfinished_erasures: Callable[[], Iterable[UnfinishedErasure]]
    # The same at a station that was one of a pair and runs alone now, where nobody takes over.
    orphaned_erasures: Callable[[], Iterable[UnfinishedErasure]]
    leader_requests: LeaderRequests  # copied from the station that leads
    forget: Callable[[str], None]  # "person ID" or "incident ID", as the active station has


class PeerFeed(Feed, Protocol):
    def offer(self, key: str, payload: bytes) -> None:
        """Callback for the bus."""
        ...

    def close(self) -> None: ...


class HaMode(Protocol):
    """Relation of a station to another one.  ``log`` and ``feed`` go to the drive."""

    @property
    def log(self) -> Log: ...

    @property
    def feed(self) -> PeerFeed: ...

    @property
    def leads(self) -> bool:
        """True if this station decides, commands and acknowledges."""
        ...

    @property
    def ha_status(self) -> HaStatus | None:
        """Status for the API."""
        ...

    def gate_to(self, drive: EngineGate) -> EngineGate:
        """Gate before the drive."""
        ...

    def may_forget(self) -> bool:
        """True if units may delete the messages of the report before the last one."""
        ...

    def note_report(self) -> None:
        """Receives the progress of the engine in the units' messages."""
        ...

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        ...

    def begin(self, place: tuple[int, int], state: StationState) -> None:
        """State of the log, before anything is added to it."""
        ...

    def start(self, gate: EngineGate, closing: ExitStack) -> None:
        """Call it when the drive runs.  ``closing`` ends it."""
        ...


class Standalone:
    """There is no other."""

    leads = True
    ha_status = None

    def __init__(self, parts: Parts) -> None:
        self.log = parts.log
        self.feed = parts.live
        self._parts = parts
        self._has_inherited = False

    def gate_to(self, drive: EngineGate) -> EngineGate:
        return drive

    def may_forget(self) -> bool:
        return True

    def note_report(self) -> None:
        pass

    def problems(self) -> tuple[str, ...]:
        return ()

    def begin(self, place: tuple[int, int], state: StationState) -> None:
        pass

    def start(self, gate: EngineGate, closing: ExitStack) -> None:  # noqa: ARG002  # the port's
        self._parts.on_lead()
        inheriting = Worker.periodic(
            "erasures", 2.0, self._inherit_erasures, "erasures of a former pair are not finished"
        )
        closing.callback(inheriting.close)
        inheriting.start()

    def _inherit_erasures(self, _stop: Event) -> None:
        """Take over, once, what the other station of a former pair has not finished."""
        if self._has_inherited:
            return
        parts = self._parts
        own = {one.subject for one in parts.erasures()}
        ordered = [one.subject for one in parts.orphaned_erasures()]
        requested = [one.subject for one in parts.leader_requests.all()]
        for subject in dict.fromkeys((*ordered, *requested)):
            if subject not in own:
                parts.forget(subject)
        parts.leader_requests.replace(())
        self._has_inherited = True


class Paired:
    """Leads, or follows the one that does."""

    def __init__(self, config: StandbyConfig, parts: Parts) -> None:
        self._config = config
        self._parts = parts
        self.log = SharedLog(parts.log, parts.clock)
        self.feed = StandbyFeed(parts.live, parts.clock)
        self._pair = HaController(
            config,
            HaDependencies(
                bus=parts.bus,
                log=self.log,
                disk=parts.disk,
                feed=self.feed,
                clock=parts.clock,
                on_lead=parts.on_lead,
                start_again=parts.start_again,
            ),
        )

    @property
    def leads(self) -> bool:
        return self._pair.leads

    @property
    def ha_status(self) -> HaStatus:
        return self._pair

    def gate_to(self, drive: EngineGate) -> EngineGate:
        return LeaderOnlyGate(drive, self._pair.copy, self._pair.refusal)

    def may_forget(self) -> bool:
        return self.leads and self._pair.copy.previous_report_is_durable()

    def note_report(self) -> None:
        self._pair.copy.note_report_received()

    def problems(self) -> tuple[str, ...]:
        return self._pair.problems()

    def begin(self, place: tuple[int, int], state: StationState) -> None:
        self.log.begin(LogPosition(*place), state.boot_id, state.take_overs)

    def start(self, gate: EngineGate, closing: ExitStack) -> None:
        parts, pair, name = self._parts, self._pair, self._config.name
        for server in (
            TableServer(name, parts.bus, parts.tables, parts.pki),
            PartServer(name, parts.bus, parts.data),
            EventServer(name, parts.bus, parts.disk),
            ErasureServer(name, parts.bus, lambda: pair.leads, parts.erasures),
        ):
            closing.callback(server.close)
        copying = TableReplication(
            parts.bus,
            parts.tables,
            parts.pki,
            leader=pair.followed,
            other=pair.reachable_peer,
            others_run=pair.others_run,
            caught_up=lambda: pair.leads or pair.in_step,
            has_until=lambda t_ns: pair.leads or self.log.place.t_ns >= t_ns,
            on_people=parts.on_people,
            on_forgotten=parts.forget,
            on_dropped=lambda details: parts.records.audit(STATION_ID, "AccountsCopied", details),
            on_restored_rows=parts.on_restored_rows,
        )
        merging = BranchMerge(
            parts.bus,
            gate,
            parts.live.deliver,
            lambda: not parts.live.late_waits and self.log.flush(),
            lambda: pair.reachable_peer() if pair.leads else None,
        )
        mending = LogRepair(
            parts.bus, parts.files, parts.check, pair.reachable_peer, parts.step_again
        )
        handover = ErasureHandover(
            parts.bus,
            lambda: pair.leads,
            pair.reachable_peer,
            parts.unfinished_erasures,
            parts.leader_requests,
            parts.forget,
        )
        threads = (
            pair,
            Worker.periodic(
                "replication", 1.0, copying.run_round, "the other station's accounts are not copied"
            ),
            Worker.periodic(
                "erasures",
                2.0,
                handover.run_round,
                "erasures of the other one are not ordered again",
            ),
            Worker.periodic(
                "mending", 5.0, mending.run_round, "the log is not mended from the other station"
            ),
            Worker.periodic(
                "merging", 2.0, merging.run_round, "what the other one set aside is not taken"
            ),
        )
        for thread in threads:
            closing.callback(thread.close)
            thread.start()
