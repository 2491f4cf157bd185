"""A client generated from the OpenAPI document does the common tasks at a station, and reads its
problems.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from http import HTTPStatus
from io import BytesIO
from pathlib import Path
from typing import Any

import httpx
import pytest
from PIL import Image
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from tests.rig.station_command import Browser, Command
from tests.rig.waiting import PATIENCE_S

PACKAGE = "generated_muster_client"
# It skips media types that it does not know; pictures and exports are files.
FILES = (
    *("image/jpeg", "image/png", "image/webp", "text/csv", "*/*"),
    *("application/pdf", "application/x-protobuf", "audio/ogg"),
    *("application/cap+xml", "application/xml", "text/xml"),
)
SETTINGS = {
    "post_hooks": [],
    "content_type_overrides": dict.fromkeys(FILES, "application/octet-stream"),
}


class Generated:
    """The client's package, by the names of the document."""

    def __init__(self, address: str, token: str) -> None:
        client = importlib.import_module(f"{PACKAGE}.client")
        self.models: Any = importlib.import_module(f"{PACKAGE}.models")
        self.types: Any = importlib.import_module(f"{PACKAGE}.types")
        self.client = client.AuthenticatedClient(address, token)
        self.stranger = client.AuthenticatedClient(address, "guess")

    def call(self, name: str, *args: Any, **kwargs: Any) -> Any:
        """The answer to one operation, ``tag.operation``, read as the document has it."""
        return self.detailed(name, *args, **kwargs).parsed

    def detailed(self, name: str, *args: Any, **kwargs: Any) -> Any:
        module: Any = importlib.import_module(f"{PACKAGE}.api.{name}")
        return module.sync_detailed(*args, **{"client": self.client, **kwargs})

    def refused(self, status: int, name: str, *args: Any, **kwargs: Any) -> str:
        """Detail of the typed problem."""
        answer = self.detailed(name, *args, **kwargs)
        assert answer.status_code == HTTPStatus(status), answer.content
        assert isinstance(answer.parsed, self.models.ProblemDocument)
        assert answer.parsed.status == status
        return str(answer.parsed.detail)


def generate(document: bytes, folder: Path) -> str:
    """Output of the generator."""
    (folder / "openapi.json").write_bytes(document)
    (folder / "settings.json").write_text(json.dumps(SETTINGS))
    done = subprocess.run(
        [
            *(Path(sys.executable).with_name("openapi-python-client"), "generate"),
            *("--path", folder / "openapi.json", "--output-path", folder / PACKAGE),
            *("--config", folder / "settings.json", "--meta", "none", "--fail-on-warning"),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.fixture
def generated(
    serve: Callable[..., Command], data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Generated]:
    address = serve().wait_ready()
    with Browser(address, data) as browser:
        administrator = {"name": "client", "role": "administrator"}
        token = browser.call("POST", "/tokens", json=administrator)["token"]
    stated = generate(
        httpx.get(f"{address}/api/v1/openapi.json", timeout=PATIENCE_S).content, tmp_path
    )
    assert "WARNING" not in stated
    monkeypatch.syspath_prepend(str(tmp_path))
    made = Generated(address, token)
    with made.client, made.stranger:
        yield made


def test_generated_client_handles_an_incident_and_problems(generated: Generated) -> None:
    person_id = enlist(generated)
    incident_id = work(generated)
    upload(generated, person_id)
    read_problems(generated, incident_id)
    watch(generated)


def enlist(muster: Generated) -> str:
    models, call = muster.models, muster.call
    ada = call("people.add_person", body=models.PersonForm(name="Ada", crew="A"))
    assert (ada.name, ada.crew, ada.photo_url) == ("Ada", "A", None)
    assert call("people.get_person", ada.person_id) == ada
    unit = call("units.register_unit", body=models.NewUnit(unit_id="FF-01", label="one"))
    assert unit.registered
    worn = models.NewAssignment(unit_id="FF-01", person_id=ada.person_id)
    assert muster.detailed("assignments.assign", body=worn).status_code == HTTPStatus.NO_CONTENT
    (assignment,) = call("assignments.list_assignments", limit=10)
    assert (assignment.person_name, assignment.until_ms) == ("Ada", None)
    return str(ada.person_id)


def work(muster: Generated) -> str:
    models, call = muster.models, muster.call
    fire = models.NewIncident(name="Fire")
    incident = call("incidents.open_incident", body=fire, idempotency_key="once")
    again = call("incidents.open_incident", body=fire, idempotency_key="once")
    assert again.incident_id == incident.incident_id
    target = models.UnitTarget(unit_id="FF-01")
    reported = models.NewCommand(kind=models.Kind.EVACUATE, target=target)
    command = call("commands.send", body=reported)
    assert [one.unit_id for one in command.units] == ["FF-01"]
    assert call("alarms.list_alarms", limit=5) == []
    assert call("health.get_health").consoles == 0
    kind = models.TrailKind.FUSED
    table = call("exports.export_incident", incident.incident_id, "csv", kind=kind)
    assert table.payload.read().startswith(b"unit_id,person,")
    return str(incident.incident_id)


def upload(muster: Generated, person_id: str) -> None:
    picture = BytesIO()
    Image.new("RGB", (64, 64), "orange").save(picture, "JPEG")
    picture.seek(0)
    file = muster.types.File(payload=picture)
    sent = muster.detailed("people.set_photo", person_id, body=file)
    assert sent.status_code == HTTPStatus.NO_CONTENT, sent.content
    assert Image.open(muster.call("people.get_photo", person_id).payload).size == (320, 320)
    broken = muster.types.File(payload=BytesIO(b"no picture"))
    assert "cannot be read" in muster.refused(422, "people.set_photo", person_id, body=broken)


def read_problems(muster: Generated, incident_id: str) -> None:
    models, refused = muster.models, muster.refused
    assert refused(404, "people.get_person", "nobody") == "There is no such person."
    assert refused(401, "people.list_people", client=muster.stranger) == "Log in first."
    assert "is empty" in refused(422, "people.add_person", body=models.PersonForm(name=""))
    other = models.NewIncident(name="Another")
    assert "open" in refused(409, "incidents.open_incident", body=other)
    wrong = models.NameConfirmation(name="Flood")
    assert refused(409, "forgetting.forget_incident", incident_id, body=wrong)


def watch(muster: Generated) -> None:
    """The WebSocket is no part of the document; it takes the same token, and no parameters."""
    client = muster.client
    address = f"{client._base_url.replace('http', 'ws', 1)}/api/v1/live"
    bearer = {"Authorization": f"Bearer {client.token}"}
    with connect(address, additional_headers=bearer) as socket:
        snapshot = json.loads(socket.recv(10.0))
    assert [unit["person"]["name"] for unit in snapshot["units"]] == ["Ada"]
    with pytest.raises(InvalidStatus) as refusal:
        connect(f"{address}?unit=FF-01", additional_headers=bearer)
    answer = refusal.value.response
    assert answer.status_code == 422
    assert b"unit is not a parameter here" in (answer.body or b"")
