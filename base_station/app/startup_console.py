"""Read-only console of the stored snapshot, shown while a starting station reads its log."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from threading import Event, Thread

from starlette.types import ASGIApp

from base_station.api.app import create_app
from base_station.api.hub import Hub
from base_station.api.replays import ReplayPlayer, Replays
from base_station.api.server import ConsoleServer
from base_station.api.services import Services
from base_station.app.station_storage import StationStorage
from base_station.app.stored_snapshot import StoredSnapshotSource
from base_station.config import HttpConfig, StationConfig
from base_station.engine.ports import Record
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.base_maps import BaseMaps
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.models import IncidentRow
from base_station.storage.imports import ImportFolder
from base_station.storage.projection import FinishedTables
from shared.errors import UserError
from shared.mcap_log import SegmentInfo

_SERVE_AFTER_S = 1.0  # most starts are over before
_ANNOUNCE_EVERY_S = 5.0
_RECORDS_PER_REPORT = 1000  # records

Announce = Callable[[str], None]
Watch = Callable[[Iterable[Record]], Iterator[Record]]
ReportProgress = Callable[[float], None]  # how much of the log is read, 0..1


@contextmanager
def serve_while_recovering(
    log: Sequence[SegmentInfo],
    listening: socket.socket,
    http: HttpConfig,
    make_application: Callable[[], tuple[ASGIApp, ReportProgress]],
    announce: Announce,
) -> Iterator[Watch]:
    """Gives a function for the records to be stepped to pass through, on their way from ``log``.

    Where that takes longer than a second, the application of ``make_application`` answers at the
    console's address and receives the progress; ``announce`` prints it every five seconds.
    ``listening`` stays open.
    """
    progress = _Progress(listening, http, make_application, announce)
    end_ns = max((segment.end_ns for segment in log), default=0)

    def watched(records: Iterable[Record]) -> Iterator[Record]:
        first_ns = 0
        for number, record in enumerate(records):
            if number % _RECORDS_PER_REPORT == 0:
                first_ns = first_ns or record[0]
                progress.report_progress((record[0] - first_ns) / max(end_ns - first_ns, 1))
            yield record

    try:
        yield watched
    finally:
        progress.close()


class _Progress:
    def __init__(
        self,
        listening: socket.socket,
        http: HttpConfig,
        make_application: Callable[[], tuple[ASGIApp, ReportProgress]],
        announce: Announce,
    ) -> None:
        self._listening = listening
        self._http = http
        self._make_application = make_application
        self._announce = announce
        self._started_s = self._announced_s = time.monotonic()
        self._server: _StartupServer | None = None
        self._report_progress: ReportProgress = lambda _: None

    def report_progress(self, fraction: float) -> None:
        fraction = min(max(fraction, 0.0), 1.0)
        now_s = time.monotonic()
        if self._server is None and now_s - self._started_s > _SERVE_AFTER_S:
            app, self._report_progress = self._make_application()
            self._server = _StartupServer(app, self._listening, self._http)
        self._report_progress(fraction)
        if now_s - self._announced_s > _ANNOUNCE_EVERY_S:
            self._announced_s = now_s
            self._announce(f"reading the log: {fraction:.0%}")

    def close(self) -> None:
        if self._server is not None:
            self._server.close()


class _StartupServer:
    """Server in a thread of its own, on a second handle to the socket."""

    def __init__(self, app: ASGIApp, listening: socket.socket, http: HttpConfig) -> None:
        self._server = ConsoleServer(app, listening.dup(), http.certificate, http.private_key)
        # Pending work, such as a TLS handshake, ends with the loop, which runs in another thread.
        self._runner = asyncio.Runner(loop_factory=asyncio.new_event_loop)
        self._loop = self._runner.get_loop()
        self._started = Event()
        self._thread = Thread(target=self._run, name="recovering", daemon=True)
        self._thread.start()
        self._started.wait()

    def close(self) -> None:
        self._loop.call_soon_threadsafe(self._server.stop)
        self._thread.join()
        self._runner.close()

    def _run(self) -> None:
        self._loop.call_soon(self._started.set)
        self._runner.run(self._server.serve())


def startup_application(
    config: StationConfig, disk: StationStorage
) -> tuple[ASGIApp, ReportProgress]:
    """Return the application, and a function that takes the fraction of the log that was read."""
    hub = Hub()
    known = StoredSnapshotSource(disk.roster, disk.records, disk.clock, hub)
    services = Services(
        accounts=disk.accounts,
        roster=disk.roster,
        records=disk.records,
        base_maps=BaseMaps(disk.store),
        archived=ArchivedCopies(disk.store),
        imports=ImportCatalogue(disk.store, ImportFolder(disk.folder.imports)),
        hub=hub,
        gate=known,
        projection=FinishedTables(),
        replays=Replays(_no_replay),
        erasures=None,
        clock=disk.clock,
        secure=config.http.certificate is not None,
        ha_status=known,
        accountability=config.accountability,
    )

    def started(loop: asyncio.AbstractEventLoop) -> None:
        hub.connect(loop, known)

    return create_app(services, started), known.report_progress


def _no_replay(_incident: IncidentRow, _speed: float, _hub: Hub) -> ReplayPlayer:
    raise UserError("the station is reading its log; replay when it is done")
