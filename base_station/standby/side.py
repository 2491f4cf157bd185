"""A station stands alone or is one of two; the composition root sees no difference."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from base_station.api.standing import Standing
from base_station.clocks.steady import SteadyClock
from base_station.config import StandbyConfig
from base_station.db.records import Records
from base_station.db.replicated_tables import ReplicatedTables
from base_station.feed import LiveFeed, LogFeed
from base_station.live.drive_ports import Feed, Log
from base_station.live.sinks import OperatorGate
from base_station.live_state import StationState
from base_station.pki.folder import PkiFolder
from base_station.standby.asking import Rounds
from base_station.standby.confirming import LeadersGate
from base_station.standby.mending import EventServer, LogFiles, Mending
from base_station.standby.merging import Merging, PartServer
from base_station.standby.pair import Around, Pair
from base_station.standby.places import Place
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from base_station.standby.table_replication import TableReplication, TableServer
from base_station.storage.log_check import LogCheck
from shared.bus import Bus
from shared.messages import STATION_ID


@dataclass(frozen=True)
class Parts:
    """What the rest of the station is made of."""

    data: Path
    bus: Bus
    log: Log
    disk: LogFeed
    files: LogFiles
    check: LogCheck
    live: LiveFeed
    clock: SteadyClock
    tables: ReplicatedTables
    records: Records
    pki: PkiFolder
    on_people: Callable[[], None]  # people or photos may have changed
    on_lead: Callable[[], None]
    start_again: Callable[[Place | None], None]
    step_again: Callable[[int], None]  # the log up to this time, in which something was missing
    forget: Callable[[str], None]  # "person ID" or "incident ID", as the active station has


class HearingFeed(Feed, Protocol):
    def offer(self, key: str, payload: bytes) -> None:
        """What the bus calls."""
        ...

    def close(self) -> None: ...


class Side(Protocol):
    """How a station stands to another one.  ``log`` and ``feed`` go to the drive."""

    @property
    def log(self) -> Log: ...

    @property
    def feed(self) -> HearingFeed: ...

    @property
    def leads(self) -> bool:
        """Whether this station decides, commands and acknowledges."""
        ...

    @property
    def standing(self) -> Standing | None:
        """What the API knows of it."""
        ...

    def gate_to(self, drive: OperatorGate) -> OperatorGate:
        """What stands before the drive."""
        ...

    def may_forget(self) -> bool:
        """Whether units may forget what the report before the last one told of."""
        ...

    def note_report(self) -> None:
        """The drive reports what it has of the units' messages."""
        ...

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        ...

    def begin(self, place: tuple[int, int], state: StationState) -> None:
        """What the log says, before anything is added to it."""
        ...

    def start(self, gate: OperatorGate, closing: ExitStack) -> None:
        """When the drive runs.  ``closing`` ends it."""
        ...


class OnlyStation:
    """There is no other."""

    leads = True
    standing = None

    def __init__(self, parts: Parts) -> None:
        self.log = parts.log
        self.feed = parts.live
        self._on_lead = parts.on_lead

    def gate_to(self, drive: OperatorGate) -> OperatorGate:
        return drive

    def may_forget(self) -> bool:
        return True

    def note_report(self) -> None:
        pass

    def problems(self) -> tuple[str, ...]:
        return ()

    def begin(self, place: tuple[int, int], state: StationState) -> None:
        pass

    def start(self, gate: OperatorGate, closing: ExitStack) -> None:  # noqa: ARG002  # the port's
        self._on_lead()


class OneOfTwo:
    """Leads, or follows the one that does."""

    def __init__(self, config: StandbyConfig, parts: Parts) -> None:
        self._config = config
        self._parts = parts
        self.log = SharedLog(parts.log, parts.clock)
        self.feed = StandbyFeed(parts.live, parts.clock)
        self._pair = Pair(
            config,
            Around(
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
    def standing(self) -> Standing:
        return self._pair

    def gate_to(self, drive: OperatorGate) -> OperatorGate:
        return LeadersGate(drive, self._pair.copy, self._pair.refusal)

    def may_forget(self) -> bool:
        return self.leads and self._pair.copy.has_report_before()

    def note_report(self) -> None:
        self._pair.copy.report_comes()

    def problems(self) -> tuple[str, ...]:
        return self._pair.problems()

    def begin(self, place: tuple[int, int], state: StationState) -> None:
        self.log.begin(Place(*place), state.boot_id, state.take_overs)

    def start(self, gate: OperatorGate, closing: ExitStack) -> None:
        parts, pair, name = self._parts, self._pair, self._config.name
        for server in (
            TableServer(name, parts.bus, parts.tables, parts.pki),
            PartServer(name, parts.bus, parts.data),
            EventServer(name, parts.bus, parts.disk),
        ):
            closing.callback(server.close)
        copying = TableReplication(
            parts.bus,
            parts.tables,
            parts.pki,
            leader=pair.followed,
            other=pair.other_there,
            others_run=pair.others_run,
            caught_up=lambda: pair.leads or pair.in_step,
            on_people=parts.on_people,
            on_forgotten=parts.forget,
            on_dropped=lambda said: parts.records.audit(STATION_ID, "AccountsCopied", said),
        )
        merging = Merging(
            parts.bus,
            gate,
            parts.live.deliver,
            lambda: not parts.live.late_waits and self.log.flush(),
            lambda: pair.other_there() if pair.leads else None,
        )
        mending = Mending(parts.bus, parts.files, parts.check, pair.other_there, parts.step_again)
        threads = (
            pair,
            Rounds("replication", 1.0, copying.look, "the other station's accounts are not copied"),
            Rounds("mending", 5.0, mending.look, "the log is not mended from the other station"),
            Rounds("merging", 2.0, merging.look, "what the other one set aside is not taken"),
        )
        for thread in threads:
            closing.callback(thread.close)
            thread.start()
