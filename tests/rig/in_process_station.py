"""A station without threads of its own, bus or log: what the API's tests talk to.

The pipeline is the real one; an action is stepped in the thread that submits it.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import httpx
from fastapi import FastAPI
from starlette.routing import BaseRoute

from base_station.accounts.principals import Role
from base_station.api.app import create_app
from base_station.api.hub import Hub
from base_station.api.replays import ReplayPlayer, Replays
from base_station.api.services import Services
from base_station.core import idempotency
from base_station.core.alarms import ALARMS
from base_station.core.events import (
    ClosedIncidentChanged,
    Output,
    Received,
    Refused,
    UnitChanged,
    event_of,
)
from base_station.core.pipeline import StationPipeline
from base_station.dispatch.alert_intake import AlertIntake
from base_station.engine.admission import Admission, classify
from base_station.engine.ports import ActionResult, DeliveryResult, Trails
from base_station.engine.sample_intake import SampleIntake
from base_station.engine.trail_encoder import TrailEncoder
from base_station.fusion import FUSERS
from base_station.privacy.erasure_queue import ErasureQueue
from base_station.privacy.erasure_service import ErasureService
from base_station.privacy.log_files import ClosedLog
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.base_maps import BaseMaps
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.projection import SqlProjection
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.imports import ImportFolder
from base_station.storage.projection import Projection
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from base_station.views.station import StationFacts, snapshot
from base_station.views.wire import Delta, Snapshot
from shared.bus_memory import MemoryRouter
from shared.clock import Clock
from shared.errors import UserError
from shared.header_factory import HeaderFactory
from shared.messages import (
    STATION_ID,
    AlarmChange,
    ExternalMarker,
    ExternalMarkers,
    FusedPosition,
    Message,
    OperatorAction,
    UnitDescription,
)
from shared.messages.station import Action
from tests.rig.quick_hash import QUICK_HASH

PASSWORD = "correct horse battery"
ORIGIN = "http://station"


class SteppedEngine:
    """Gate, live source and projection in one, stepped by whoever calls."""

    def __init__(self, clock: Clock, projection: SqlProjection, roster: Roster, hub: Hub) -> None:
        self._clock = clock
        self._projection = projection
        self._roster = roster
        self._hub = hub
        self._header_factory = HeaderFactory(STATION_ID, 1, clock)
        self._pipeline = StationPipeline(ALARMS, FUSERS[0])
        self._lock = threading.RLock()
        self._seq = 0

    def receive(self, message: Message) -> list[Output]:
        """Step the pipeline with a message, as if it had come now."""
        with self._lock:
            t_ns = self._clock.utc_ns()
            outputs = self._pipeline.step(Received(t_ns, message.header.unit_id, message))
            refused = any(isinstance(output, Refused) for output in outputs)
            self._projection.project(
                Projection(
                    t_ns,
                    alarms=tuple(one for one in outputs if isinstance(one, AlarmChange)),
                    tracks=tuple(one for one in outputs if isinstance(one, FusedPosition)),
                    actions=(message,)
                    if isinstance(message, OperatorAction) and not refused
                    else (),
                    descriptions=(message,) if isinstance(message, UnitDescription) else (),
                    news=tuple(
                        one.incident_id for one in outputs if isinstance(one, ClosedIncidentChanged)
                    ),
                    last_messages=((message.header.unit_id, t_ns),)
                    if message.header.unit_id != STATION_ID
                    else (),
                )
            )
            self._seq += 1
            changed = {one.unit_id for one in outputs if isinstance(one, UnitChanged)}
            units = tuple(one for one in self.picture().units if one.unit_id in changed)
            self._hub.delta(Delta(self._seq, t_ns // 1_000_000, units=units))
            return outputs

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
        done: Future[ActionResult] = Future()
        before = ActionResult.before(self._pipeline.state, action_id)
        done.set_result(before or self._do(by, action, action_id))
        return done

    def deliver(self, messages: Sequence[tuple[str, bytes]]) -> Future[DeliveryResult]:
        admissions: list[Admission] = []
        for key, payload in messages:
            event = event_of(self._clock.utc_ns(), key, payload)
            admissions.append(classify(key, event, self._pipeline.state))
            if admissions[-1] is Admission.ACCEPT:
                assert isinstance(event, Received)
                self.receive(event.message)
        done: Future[DeliveryResult] = Future()
        done.set_result(DeliveryResult(tuple(admissions)))
        return done

    def note_external(self, markers: tuple[ExternalMarker, ...], removed: tuple[str, ...]) -> None:
        self.receive(ExternalMarkers(self._header_factory.header(), markers, removed))

    def _do(self, by: str, action: Action, action_id: str) -> ActionResult:
        header = self._header_factory.header()
        action_id = action_id or f"action-{header.seq}"
        outputs = self.receive(OperatorAction(header, action_id, by, action))
        refused = next((one for one in outputs if isinstance(one, Refused)), None)
        return ActionResult(
            action_id, self._clock.utc_ns(), refused, idempotency.created_id_of(action)
        )

    def request_snapshot(self, deliver: Callable[[Snapshot, Trails], None]) -> None:
        with self._lock:
            trails = TrailEncoder().all(self._pipeline.state.units.values())
            deliver(self.picture(), trails)

    def picture(self) -> Snapshot:
        with self._lock:
            state = self._pipeline.state
            return snapshot(state, self._seq, StationFacts(), self._roster.known)


def no_replays(_incident: IncidentRow, _speed: float, _hub: Hub) -> ReplayPlayer:
    raise UserError("this station has no log")


def query_without_answer(_unit_id: str, _question: str) -> None:
    return None


_routes: list[BaseRoute] = []


def _routes_of(app: FastAPI) -> list[BaseRoute]:
    if not _routes:
        _routes.extend(app.routes)
    return _routes


class InProcessStation:
    """The API on a fresh data folder with one user of each role, each named like the role."""

    def __init__(self, folder: Path, clock: Clock) -> None:
        database = folder / "station.sqlite"
        if not database.exists():
            database.write_bytes(_new_database())
        self.store = Store(database)
        self.projection = SqlProjection(self.store)
        self.hub = Hub()
        self.router = MemoryRouter()
        roster = Roster(self.store, clock)
        self.drive = SteppedEngine(clock, self.projection, roster, self.hub)
        service = ErasureService(
            ClosedLog(folder / "log"),
            self.store,
            Checkpoints(folder / "checkpoints"),
            Records(self.store, clock),
            clock,
            TransferQueue(query_without_answer, folder / "recordings", clock),
            self.drive.submit,
        )
        self.erasures = ErasureQueue(
            service, folder / "forgetting.json", lambda _: "", lambda _: None
        )
        self.erasures.__enter__()
        self.services = Services(
            accounts=Accounts(self.store, clock, QUICK_HASH),
            roster=roster,
            records=Records(self.store, clock),
            base_maps=BaseMaps(self.store),
            hub=self.hub,
            gate=self.drive,
            projection=self.projection,
            replays=Replays(no_replays),
            erasures=self.erasures,
            clock=clock,
            secure=False,
            alerts=AlertIntake(self.drive.note_external),
            archived=ArchivedCopies(self.store),
            imports=ImportCatalogue(self.store, ImportFolder(folder / "imports")),
            intake=SampleIntake(self.drive.deliver, self.router.attach_station(), clock),
        )
        self.app = create_app(
            self.services, started=lambda loop: self.hub.connect(loop, self.drive)
        )
        # The same of every app, and know of no station: the first one finds out what each takes.
        self.app.routes[:] = _routes_of(self.app)
        for role in Role:
            self.services.accounts.add_user(role.word, PASSWORD, role)

    def client(self, role: Role | None = None) -> httpx.AsyncClient:
        """Over ASGI, with an API token of the user of this role; in the loop that answers it."""
        self.hub.connect(asyncio.get_running_loop(), self.drive)
        headers = {}
        if role is not None:
            _, secret = self.services.accounts.add_token(role.word, "test", role, None)
            headers["Authorization"] = f"Bearer {secret}"
        transport = httpx.ASGITransport(self.app, raise_app_exceptions=False)
        return httpx.AsyncClient(transport=transport, base_url=f"{ORIGIN}/api/v1", headers=headers)

    def close(self) -> None:
        self.erasures.__exit__()
        self.projection.close()
        self.store.close()


@cache
def _new_database() -> bytes:
    """Made once for all tests of a process."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "station.sqlite"
        Store(path).close()
        return path.read_bytes()
