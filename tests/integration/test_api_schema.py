"""The API conforms to its OpenAPI document for any request (schemathesis)."""

from __future__ import annotations

import asyncio
import re
import threading
import uuid
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, given, settings
from schemathesis import Case
from schemathesis.core.failures import FailureGroup
from schemathesis.core.result import Ok
from schemathesis.schemas import APIOperation
from schemathesis.specs.openapi.checks import ignored_auth, positive_data_acceptance

from base_station.accounts.principals import Role
from base_station.api.forms import IDEMPOTENCY_KEY
from base_station.api.server import ConsoleServer, bind
from base_station.engine.log_feed import FolderFeed
from base_station.replay.timelines.unit_timeline import read_timeline
from shared.clock import ManualClock
from tests.rig.in_process_station import InProcessStation

EXAMPLES = 15  # of each operation
FRAMEWORK = re.compile("Input should|Field required|Value error|not permitted")  # its own words
# What makes a plan, a photo or a dispatch cannot be said in a schema, nor that columns have one
# length.
MORE_THAN_TYPES = (
    "POST /api/v1/units/{unit_id}/samples",
    "PUT /api/v1/site/plan",
    "PUT /api/v1/site/base-map",
    "PUT /api/v1/people/{person_id}/photo",
    "POST /api/v1/people/import",
    "POST /api/v1/site/drafts",
    "POST /api/v1/dispatch",
    "POST /api/v1/dispatch/alerts",
)


@pytest.fixture(scope="module")
def station(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, str]]:
    """Address of a served station and an administrator's token."""
    folder: Path = tmp_path_factory.mktemp("station")
    desk = InProcessStation(folder, ManualClock())
    _, token = desk.services.accounts.add_token("administrator", "t", Role.ADMINISTRATOR, None)
    (folder / "log").mkdir()
    read = partial(read_timeline, desk.services.records, FolderFeed(folder / "log"))
    desk.app.state.services = replace(desk.services, read_timeline=read)
    desk.hub.reset(desk.drive.picture(), {})  # health is known once the drive has spoken
    listening = bind("127.0.0.1", 0)
    port = listening.getsockname()[1]
    server = ConsoleServer(desk.app, listening)
    thread = threading.Thread(target=lambda: asyncio.run(server.serve()))
    thread.start()
    yield f"http://127.0.0.1:{port}", token
    server.stop()
    thread.join()
    desk.close()


def test_responses_follow_the_api_document(station: tuple[str, str]) -> None:
    address, token = station
    document = schemathesis.openapi.from_url(f"{address}/api/v1/openapi.json")
    operations = [one.ok() for one in document.get_all_operations() if isinstance(one, Ok)]
    assert len(operations) > 40
    failures = {}
    for operation in operations:
        try:
            check(operation, token)
        except (AssertionError, FailureGroup) as error:
            failures[operation.label] = error
    assert not failures, "\n\n".join(f"{label}: {error}" for label, error in failures.items())


def check(operation: APIOperation[Any, Any, Any, Any], token: str) -> None:
    """Valid and invalid requests of one operation, answered as the document says."""
    # Our token is valid beside whatever cookie is generated; test_api_security holds the rest.
    excluded = [ignored_auth]
    if operation.label in MORE_THAN_TYPES:
        excluded.append(positive_data_acceptance)

    @settings(
        max_examples=EXAMPLES,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy())
    def answers(case: Case[Any]) -> None:
        with_a_key_of_its_own(case)
        answer = case.call_and_validate(
            headers={"Authorization": f"Bearer {token}"}, excluded_checks=excluded, timeout=20.0
        )
        if answer.status_code == 422:
            assert not FRAMEWORK.search(answer.json()["detail"]), answer.json()

    answers()


def with_a_key_of_its_own(case: Case[Any]) -> None:
    """A schema cannot say that a key is good for one request."""
    if re.fullmatch(IDEMPOTENCY_KEY, case.headers.get("Idempotency-Key", "")):
        case.headers["Idempotency-Key"] = uuid.uuid4().hex
