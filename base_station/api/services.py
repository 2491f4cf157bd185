"""What the routes work with, and how they reach it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import TimeoutError as FutureTimeoutError
from dataclasses import dataclass, field
from threading import Lock
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from base_station.api.hub import Hub
from base_station.api.problems import Problem
from base_station.api.replays import Replays
from base_station.api.standing import Standing
from base_station.config import AccountabilityConfig
from base_station.db.accounts import Accounts
from base_station.db.base_maps import BaseMaps
from base_station.db.records import Records
from base_station.db.roster import Roster
from base_station.forgetting.desk import ForgettingDesk
from base_station.live.sinks import ActionDone, OperatorGate
from base_station.once import asks_the_same
from base_station.past.hindsight import Hindsight
from base_station.recordings.desk import RecordingDesk
from base_station.views.wire import Snapshot
from shared.clock import Clock
from shared.errors import StoreError, UserError
from shared.messages.station import Action

ACTION_TIMEOUT_S = 10.0


@dataclass(frozen=True)
class Services:
    accounts: Accounts
    roster: Roster
    records: Records
    base_maps: BaseMaps
    hub: Hub
    gate: OperatorGate
    settle: Callable[[], object]  # waits until what was decided can be read from the store
    replays: Replays
    forgettings: ForgettingDesk | None  # None: a station that only replays
    clock: Clock
    secure: bool  # the console is served over TLS
    standing: Standing | None = None  # None: this is the only station
    only_replays: bool = False  # what is changed would be lost with its copy of the database
    recordings: RecordingDesk | None = None  # None: a station that only replays
    hindsight: Hindsight | None = None  # None: a station without a log
    accountability: AccountabilityConfig = field(default_factory=AccountabilityConfig)
    darkroom: Lock = field(default_factory=Lock)  # one picture at a time: each may take 400 MB
    # One whole incident at a time: an hour of a hundred units takes 300 MB.  Who waits holds no
    # thread: those are for who acts.
    copying: asyncio.Lock = field(default_factory=asyncio.Lock)

    def act(self, by: str, action: Action, action_id: str = "") -> ActionDone:
        """Have the drive take a person's action, and wait until it can be read everywhere.

        Raises UserError with the reason where the action had no effect.  ``action_id``: as of
        ``OperatorGate``; Problem 422 where the client's key came with another request before.
        """
        try:
            done = self.gate.submit(by, action, action_id).result(ACTION_TIMEOUT_S)
        except FutureTimeoutError:
            again = (
                "with the same Idempotency-Key it is done once, however often it is sent"
                if action_id
                else "look before you do it again"
            )
            raise StoreError(
                f"the station is busy and has not done this yet; it may still do it: {again}"
            ) from None
        if not asks_the_same(action_id, done.action_id):
            raise key_used_before()
        if done.refused is not None:
            raise UserError(done.refused.reason)
        self.settle()
        return done

    def picture(self) -> Snapshot:
        """What the consoles show now, but for trails."""
        try:
            return self.hub.snapshot().result(ACTION_TIMEOUT_S)
        except FutureTimeoutError:
            raise StoreError("the station is too busy to say this now; try again") from None


def key_used_before() -> Problem:
    return Problem(
        422,
        "This Idempotency-Key came with another request before, and this one was not done: give "
        "every request a key of its own.",
    )


def services_of(connection: HTTPConnection) -> Services:
    services: Services = connection.app.state.services
    return services


Station = Annotated[Services, Depends(services_of)]
