"""Composition for the transfer of one recording beside a running station, whose router is used."""

from __future__ import annotations

import getpass
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from base_station.config import StationConfig
from base_station.engine.station_clock import SteadyClock
from base_station.security.router.router import station_endpoint
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.database import Database
from base_station.storage.db.opening import open_database
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.unit_sync.recordings.transfer import (
    Transfer,
    TransferRequest,
    TransferState,
    ask_via_bus,
)
from shared.bus_zenoh import ZenohBus
from shared.clock import SystemClock
from shared.errors import UserError

Show = Callable[[Transfer], None]
_REST_S = 0.5  # when the unit does not answer


def window_of(config: StationConfig, incident_id: str) -> tuple[int, int]:
    """Start and end of an incident in station time; of an open one, until now.  Raises
    UserError.
    """
    with ExitStack() as closing:
        records = Records(_store(config, closing), SystemClock())
        incident = records.require_incident(incident_id)
        return incident.opened_ns, incident.closed_ns or _now_ns(records)


def since(config: StationConfig, from_ns: int) -> tuple[int, int]:
    """Start and end, in station time, of the span from a time until now."""
    with ExitStack() as closing:
        return from_ns, _now_ns(Records(_store(config, closing), SystemClock()))


def pull(config: StationConfig, wanted: TransferRequest, show: Show) -> tuple[Path, str]:
    """Transfer a recording; ``show`` is called at every step.  Returns its folder, and a sentence
    about parts that are missing.

    Raises MusterError with one sentence if nothing can be transferred.
    """
    clock = SystemClock()
    with ExitStack() as closing:
        store = _store(config, closing)
        known = Roster(store, clock).registered_units()
        if wanted.unit_id not in known:
            names = ", ".join(sorted(known)) or "none"
            raise UserError(f"there is no unit {wanted.unit_id}; known are: {names}")
        bus = ZenohBus(station_endpoint(config.data, config.bus.listen))
        closing.callback(bus.close)
        folder = DataFolder(config.data).recordings
        fetch = Transfer(ask_via_bus(bus), folder, wanted, clock)
        closing.callback(fetch.close)
        details = f"{wanted.unit_id} from {wanted.from_ns} to {wanted.to_ns}"
        Records(store, clock).audit(getpass.getuser(), "FetchedRecording", details)
        while not fetch.state.is_over:
            fetch.step()
            show(fetch)
            if fetch.state is TransferState.WAITING:
                time.sleep(_REST_S)
        if fetch.state is TransferState.FAILED:
            raise UserError(fetch.problem)
        return fetch.folder, fetch.problem


def _now_ns(records: Records) -> int:
    """Station time now; it continues from the last recorded time if the machine's clock was set
    back.
    """
    recorded_ns = max((one.last_ns for one in records.segments()), default=0)
    return SteadyClock(SystemClock(), recorded_ns).utc_ns()


def _store(config: StationConfig, closing: ExitStack) -> Database:
    return closing.enter_context(open_database(DataFolder(config.data).require_database()))
