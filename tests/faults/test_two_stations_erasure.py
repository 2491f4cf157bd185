"""Erasing a person at one station of a pair removes every byte at both."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from base_station.cli import app
from tests.bench.standby.station_of_pair import Place, Station
from tests.bench.standby.two_stations import TwoStations
from tests.rig.erasure_scenario import names_in, some_photo, stored_in
from tests.rig.incident_closing import despite
from tests.rig.pacing import PATIENCE_S, wait_until
from tests.rig.station_command import Command
from tests.rig.station_process import free_port
from tests.rig.two_stations import two_stations

NAME = "Zebediah Quartermaine"
OTHER = "Bo Lind"
LEADER_REQUESTS = "forgetting-of-leader.json"


@pytest.fixture
def two(tmp_path: Path, closing: ExitStack) -> TwoStations:
    """One unit, which Zebediah wore in an incident that is over, and Bo does now."""
    two = two_stations(tmp_path, (Place(), Place()), closing)
    two.start()
    two.start_unit("anna", two.first)
    two.wait_received(two.first)
    return two


def record_incident(two: TwoStations) -> tuple[str, bytes]:
    """Id and photo of the one who is to be forgotten."""
    at = two.first
    person_id = str(at.post("/people", {"name": NAME, "crew": "Engine 1"})["person_id"])
    call(at, "PUT", f"/people/{person_id}/photo", some_photo(), "image/jpeg")
    incident = at.post("/incidents", {"name": "Mill Lane"})
    call(at, "POST", "/assignments", {"unit_id": "anna", "person_id": person_id})
    text = f"{NAME} come out"
    at.post("/commands", {"kind": "text", "target": {"everyone": True}, "text": text})
    wait_until("the unit has it", lambda: at.delivered(text) == {"anna"})
    close_incident(at, incident["incident_id"])
    other_id = str(at.post("/people", {"name": OTHER, "crew": "Engine 1"})["person_id"])
    call(at, "POST", "/assignments", {"unit_id": "anna", "person_id": other_id})
    (photo,) = (
        call(at, "GET", person["photo_url"].removeprefix("/api/v1"))
        for person in at.get("/people")
        if person["person_id"] == person_id
    )
    wait_until("the other has it too", lambda: photo[200:600] in stored_in(two.second.data))
    assert names_in(stored_in(two.second.data), NAME)
    return person_id, photo[200:600]


def call(
    at: Station, method: str, path: str, body: Any = None, media: str = "application/json"
) -> bytes:
    data = body if isinstance(body, bytes) or body is None else json.dumps(body).encode()
    request = urllib.request.Request(  # our own station's address
        f"{at.url}/api/v1{path}",
        method=method,
        data=data,
        headers={"Content-Type": media, "Origin": at.url, "Cookie": at.logged_in().cookie},
    )
    with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
        return bytes(answer.read())


def close_incident(at: Station, incident_id: str) -> None:
    """Over whatever alarms are open."""
    path = f"/incidents/{incident_id}/close"
    try:
        call(at, "POST", path)
    except urllib.error.HTTPError as refused:
        call(at, "POST", path, despite(json.load(refused)))


def done(at: Station) -> bool:
    states = [one["state"] for one in at.get("/forgettings")]
    return bool(states) and set(states) == {"done"}


def left_of(at: Station, photo: bytes) -> list[str]:
    stored = stored_in(at.data)
    return [*names_in(stored, NAME), *(["photo"] if photo in stored else [])]


def end_and_compare(two: TwoStations, photo: bytes, ends_first: Station) -> None:
    """Nothing is left at either, and one log is the beginning of the other."""
    two.stop_units()
    (ends_last,) = {two.first, two.second} - {ends_first}
    for one in (ends_first, ends_last):
        one.stop()
        assert left_of(one, photo) == []
        assert names_in(stored_in(one.data), OTHER)
    short, long = ends_first.logged(), ends_last.logged()
    assert (short.duplicates, long.duplicates) == (0, 0)
    assert short.events == long.events[: len(short.events)]


def test_erasure_is_done_at_both_stations_with_identical_logs(two: TwoStations) -> None:
    person_id, photo = record_incident(two)
    two.first.post(f"/people/{person_id}/forget", {"name": NAME})
    wait_until("both have forgotten", lambda: done(two.first) and done(two.second))
    assert left_of(two.second, photo) == []
    wait_until("the second follows", two.second.follows)
    end_and_compare(two, photo, two.second)


def test_erasure_reaches_the_station_that_was_off_and_its_copies(
    two: TwoStations,
) -> None:
    person_id, photo = record_incident(two)
    two.second.kill()
    two.first.post(f"/people/{person_id}/forget", {"name": NAME})
    wait_until("the first has forgotten", lambda: done(two.first))
    assert left_of(two.first, photo) == []
    two.first.kill()
    two.second.start()
    wait_until("the second leads", two.second.leads)
    incident = two.second.post("/incidents", {"name": "Oak Street"})  # forgetting waits for its end
    call(two.second, "POST", "/assignments", {"unit_id": "anna", "person_id": person_id})
    text = f"{NAME} answer"
    two.second.post("/commands", {"kind": "text", "target": {"unit_id": "anna"}, "text": text})
    wait_until("the unit has it", lambda: two.second.delivered(text) == {"anna"})
    call(two.second, "DELETE", "/assignments/anna")
    two.first.start()
    wait_until("the first follows", two.first.follows)
    assert names_in(stored_in(two.first.data), NAME) == [], "no log brings a name back"
    close_incident(two.second, incident["incident_id"])
    wait_until("the second has forgotten", lambda: done(two.second))
    both = 2  # what it was asked for, and what the second has told it
    wait_until(
        "the first has again",
        lambda: done(two.first) and len(two.first.get("/forgettings")) == both,
    )
    end_and_compare(two, photo, two.first)


def test_erasure_of_a_leader_that_is_lost_in_the_middle_is_finished_by_the_other(
    two: TwoStations,
) -> None:
    person_id, photo = record_incident(two)
    recordings = two.first.data / "recordings"
    recordings.mkdir(exist_ok=True)
    (recordings / "anna").touch()  # no folder: removing it is tried for 20 s
    two.first.post(f"/people/{person_id}/forget", {"name": NAME})
    wait_until("the second has the order", lambda: "BeginErasure" in audited(two.second))
    two.first.kill()
    assert "ForgotPerson" not in audited(two.second)
    assert left_of(two.second, photo)
    wait_until("the second leads", two.second.leads)
    wait_until("the second has forgotten", lambda: done(two.second))
    assert left_of(two.second, photo) == []
    assert names_in(stored_in(two.second.data), OTHER)
    assert "ForgotPerson" in audited(two.second)


def test_erasure_of_a_lost_leader_is_finished_by_the_other_that_runs_alone(
    two: TwoStations, tmp_path: Path
) -> None:
    person_id, photo = record_incident(two)
    recordings = two.first.data / "recordings"
    recordings.mkdir(exist_ok=True)
    (recordings / "anna").touch()  # no folder: removing it is tried for 20 s
    two.first.post(f"/people/{person_id}/forget", {"name": NAME})
    wait_until("the second has the order", lambda: "BeginErasure" in audited(two.second))
    wait_until("the second has the request", (two.second.data / LEADER_REQUESTS).exists)
    two.first.kill()
    two.second.kill()
    assert left_of(two.second, photo)
    flags = ("--data", str(two.second.data), "--http", f"127.0.0.1:{free_port()}")
    listen = ("--listen", f"tcp/127.0.0.1:{free_port()}")
    alone = Command(tmp_path / "alone.txt", "serve", *listen, *flags)
    alone.wait_ready()
    wait_until("it has forgotten", lambda: left_of(two.second, photo) == [])
    alone.stop()
    assert names_in(stored_in(two.second.data), OTHER)


def test_erasure_by_command_on_a_stopped_station_reaches_the_other_when_both_run(
    two: TwoStations,
) -> None:
    person_id, photo = record_incident(two)
    call(two.first, "DELETE", "/assignments/anna")
    two.second.kill()
    two.first.stop()
    flags = ["forget", person_id, "--data", str(two.first.data)]
    printed = CliRunner().invoke(app, flags, input=f"{person_id}\n")
    assert printed.exit_code == 0, printed.output
    assert "until this one is started and the two are linked" in " ".join(printed.output.split())
    assert left_of(two.first, photo) == []
    two.second.start()
    wait_until("the second leads", two.second.leads)
    assert left_of(two.second, photo), "it has no request"
    two.first.start()
    wait_until("the first follows", two.first.follows)
    wait_until("both have forgotten", lambda: done(two.first) and done(two.second))
    end_and_compare(two, photo, two.first)


def audited(at: Station) -> list[str]:
    return [one["action"] for one in at.get("/audit")]
