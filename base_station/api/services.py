"""Services of the routes, and their dependencies."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from concurrent.futures import TimeoutError as FutureTimeoutError
from dataclasses import dataclass, field
from threading import Lock
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from base_station.api.ha_status import HaStatus
from base_station.api.hub import Hub
from base_station.api.problems import Problem
from base_station.api.replays import Replays
from base_station.api.route_finder import RouteFinder
from base_station.config import AccountabilityConfig, RetentionConfig
from base_station.core.alarms.thresholds import Thresholds
from base_station.core.idempotency import is_same_request
from base_station.core.person_references import with_references
from base_station.dispatch.alert_intake import AlertIntake
from base_station.dispatch.config import DispatchConfig
from base_station.engine.log_feed import LogFeed
from base_station.engine.ports import ActionResult, OperatorGate, Trails
from base_station.engine.sample_intake import SampleIntake
from base_station.privacy.erasure_queue import ErasureQueue
from base_station.radio.radio_log import RadioLog
from base_station.replay.post_processing import PostProcessor
from base_station.replay.rehearsal.report import RehearsalReport
from base_station.replay.timelines.unit_timeline import TimelineRequest, UnitTimeline
from base_station.report.alarm_explanation import AlarmExplainer
from base_station.report.process import ReportProcess
from base_station.security.pki.folder import PkiFolder
from base_station.site.plan_reader import PlanReader
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.base_maps import BaseMaps
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.projection import ProjectedTables
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from base_station.views.wire import Snapshot
from shared.clock import Clock
from shared.coded_text import coded, map_texts, text_of_error
from shared.errors import StoreError, UserError
from shared.messages.station import Action

# Sets of thresholds over an incident, and which one a sweep changes; empty: it is no sweep.
Rehearse = Callable[[IncidentRow, Sequence[Thresholds], str], RehearsalReport]

ACTION_TIMEOUT_S = 10.0
_TOO_BUSY = coded("station-too-busy", "the station is too busy to say this now; try again")


@dataclass(frozen=True, kw_only=True)
class LoginServices:
    """Services for logging in and for accounts, at a station or a department."""

    accounts: Accounts
    records: Records  # of which the audit
    secure: bool  # the console is served over TLS
    ha_status: HaStatus | None = None  # None: this is the only station
    is_replay_only: bool = False  # changes would be lost with its copy of the database


@dataclass(frozen=True, kw_only=True)
class Services(LoginServices):
    roster: Roster
    base_maps: BaseMaps
    imports: ImportCatalogue
    archived: ArchivedCopies
    hub: Hub
    gate: OperatorGate
    projection: ProjectedTables  # of which ``records`` and ``roster`` read
    replays: Replays
    erasures: ErasureQueue | None  # None: a station that only replays
    clock: Clock
    recordings: TransferQueue | None = None  # None: a station that only replays
    post_processor: PostProcessor | None = None  # None: a station without a log
    reports: ReportProcess | None = None  # None: a station that only replays
    rehearse: Rehearse | None = None  # None: a station that only replays
    # None: a station without a log.
    read_timeline: Callable[[TimelineRequest], UnitTimeline] | None = None
    log_of: Callable[[IncidentRow], LogFeed] | None = None  # None: a station without a log
    alarm_explainer: AlarmExplainer | None = None  # None: a station without a log
    radio: RadioLog | None = None  # None: a station without a log
    pki: PkiFolder | None = None  # None: a station that enrols no units
    intake: SampleIntake | None = None  # None: a station that only replays
    alerts: AlertIntake | None = None  # None: a station that only replays
    dispatch: DispatchConfig = field(default_factory=DispatchConfig)
    accountability: AccountabilityConfig = field(default_factory=AccountabilityConfig)
    retention: RetentionConfig | None = None  # None: incidents are kept
    plans: PlanReader = field(default_factory=PlanReader)  # of the drive that acts
    route_finder: RouteFinder = field(default_factory=RouteFinder)
    image_lock: Lock = field(default_factory=Lock)  # decoding takes up to 200 MB: one at a time
    # One whole incident at a time: an hour of a hundred units takes 300 MB.  Waiting
    # requests hold no thread: those are for actions.
    export_lock: asyncio.Lock = field(default_factory=asyncio.Lock)
    import_lock: asyncio.Lock = field(default_factory=asyncio.Lock)  # one file is read at a time
    rehearsal_lock: asyncio.Lock = field(default_factory=asyncio.Lock)  # minutes for a long one
    timeline_lock: asyncio.Lock = field(default_factory=asyncio.Lock)  # as above, shorter work

    def perform(self, by: str, action: Action, action_id: str = "") -> ActionResult:
        """Let the drive carry out a person's action, and wait until it is decided and in the log.
        The database gets it later; reads of tables wait for that (``current_tables``). Names of the
        roster in its texts go into the log as references.

        Raises UserError with the reason if the action had no effect.  ``action_id``: as in
        ``OperatorGate``; Problem 422 if the client has used its key for another request before.
        """
        try:
            nameless = with_references(action, self.roster.ids_by_name())
            done = self.gate.submit(by, nameless, action_id).result(ACTION_TIMEOUT_S)
        except FutureTimeoutError:
            raise StoreError(_may_still_be_done(is_safe_again=bool(action_id))) from None
        if not is_same_request(action_id, done.action_id):
            raise idempotency_key_reused()
        if done.refused is not None:
            raise UserError(map_texts(done.refused.reason, self.roster.shown))
        self.projection.flush_soon()
        return done

    def picture(self) -> Snapshot:
        """Return the present snapshot without trails."""
        try:
            return self.hub.snapshot().result(ACTION_TIMEOUT_S)
        except FutureTimeoutError:
            raise StoreError(_TOO_BUSY) from None

    def picture_with_trails(self) -> tuple[Snapshot, Trails]:
        """Return the present snapshot with the trails of all units."""
        try:
            return self.hub.picture().result(ACTION_TIMEOUT_S)
        except FutureTimeoutError:
            raise StoreError(_TOO_BUSY) from None

    def worn_by(self, person_id: str) -> Sequence[str]:
        """Units that the person wears now."""
        return [
            unit.unit_id
            for unit in self.picture().units
            if unit.person is not None and unit.person.person_id == person_id
        ]


def audit_given_out(station: Services, by: str, kind: str, what: str) -> None:
    """Enter the data that is about to be given out in the audit.  Problem 503 if that fails."""
    try:
        station.records.audit(by, kind, what)
    except StoreError as error:
        raise Problem(
            503,
            coded(
                "export-not-audited",
                "Nothing is given out that the audit cannot say: {reason}.",
                reason=text_of_error(error),
            ),
        ) from error


def _may_still_be_done(*, is_safe_again: bool) -> str:
    if is_safe_again:
        return coded(
            "busy-send-again",
            "the station is busy and has not done this yet; it may still do it: with the same "
            "Idempotency-Key it is done once, however often it is sent",
        )
    return coded(
        "busy-look-first",
        "the station is busy and has not done this yet; it may still do it: look before you do it "
        "again",
    )


def idempotency_key_reused() -> Problem:
    return Problem(
        422,
        coded(
            "idempotency-key-reused",
            "This Idempotency-Key came with another request before, and this one was not done: "
            "give every request a key of its own.",
        ),
    )


def services_of(connection: HTTPConnection) -> Services:
    services: Services = connection.app.state.services
    return services


def login_services_of(connection: HTTPConnection) -> LoginServices:
    services: LoginServices = connection.app.state.services
    return services


Logins = Annotated[LoginServices, Depends(login_services_of)]
Station = Annotated[Services, Depends(services_of)]
