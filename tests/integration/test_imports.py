"""Imported files in an incident: over the API, by the command, and their later changes."""

from __future__ import annotations

import hashlib
import shutil
import threading
from collections import namedtuple
from collections.abc import AsyncIterator
from pathlib import Path

import httpx
import pytest
import pytest_asyncio
from typer.testing import CliRunner, Result

from base_station.accounts.principals import Role
from base_station.cli import app
from base_station.core.person_references import reference_to
from base_station.importers import requests
from base_station.importers.interface import MOST_BYTES
from base_station.importers.requests import ImportAction, ImportRequests
from base_station.storage import request_files
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.imports import ImportFolder
from shared.channels import OPERATOR
from shared.clock import NS_PER_S, ManualClock, SystemClock
from shared.errors import StoreError, UserError
from shared.mcap_log import read_log
from shared.messages import STATION_ID
from shared.messages.station import RemoveImport
from tests.rig.imported_files import exif_time, line, write_gpx, write_photo
from tests.rig.in_process_station import InProcessStation
from tests.rig.waiting import until
from tests.rig.walked_folder import ANCHOR, new_folder


def muster(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, list(map(str, arguments)))


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return new_folder(tmp_path_factory.mktemp("station"), "i1")


@pytest.fixture
def data(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "data"))


@pytest.fixture(scope="module")
def other_incident(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Incident of another station, as a file that stands alone."""
    folder = new_folder(tmp_path_factory.mktemp("other"), "n1", 40)
    file = tmp_path_factory.mktemp("given") / "north.mcap"
    result = muster("export", "n1", file, "--data", folder)
    assert result.exit_code == 0, result.output
    return file


def opened_s(data: Path) -> int:
    with Store(data / "station.sqlite") as store:
        return Records(store, SystemClock()).require_incident("i1").opened_ns // NS_PER_S


def ids_in(data: Path) -> list[str]:
    with Store(data / "station.sqlite") as store:
        return [row.import_id for row in Records(store, SystemClock()).imports_of("i1")]


def files_in(data: Path) -> set[str]:
    return {path.name for path in ImportFolder(data / "imports").files()}


@pytest_asyncio.fixture
async def commander(station: InProcessStation) -> AsyncIterator[httpx.AsyncClient]:
    async with station.client(Role.COMMANDER) as client:
        yield client


async def test_file_is_imported_once_shown_on_the_plan_and_removed(
    station: InProcessStation, commander: httpx.AsyncClient, clock: ManualClock, tmp_path: Path
) -> None:
    now_s = clock.utc_ns() // NS_PER_S
    incident_id = (await commander.post("/incidents", json={"name": "Mill"})).json()["incident_id"]
    imports = f"/incidents/{incident_id}/imports"
    track = write_gpx(tmp_path / "drone.gpx", "Drone", line(now_s, 30)).read_bytes()
    refused = await commander.post(imports, params={"file_name": "drone.gpx"}, content=track)
    assert refused.status_code == 409
    assert "set the anchor first" in refused.json()["detail"]
    place = {"lat_deg": ANCHOR.lat_deg, "lon_deg": ANCHOR.lon_deg, "plan_rotation_rad": 0.3}
    assert (await commander.put("/site/anchor", json=place)).status_code < 300

    added = [
        (await commander.post(imports, params={"file_name": "drone.gpx"}, content=track)).json()
        for _ in range(2)
    ]
    assert added[0] == added[1]
    assert (await commander.get(imports)).json() == [added[0]]
    one = added[0]
    assert one["sha256"] == hashlib.sha256(track).hexdigest()
    assert (one["by"], one["file_name"], one["names"]) == ("commander", "drone.gpx", ["Drone"])
    assert (one["from_ms"], one["tracks"], one["is_here"]) == (now_s * 1000, 1, True)
    untimed = write_gpx(tmp_path / "walk.gpx", "Walk", line(now_s, 2)).read_text()
    untimed = untimed.replace("</trkseg>", '<trkpt lat="52" lon="4"/></trkseg>')
    walk = await commander.post(imports, params={"file_name": "walk.gpx"}, content=untimed)
    assert walk.json()["warnings"] == ["1 points without a place or a time are left out"]
    assert [one["code"] for one in walk.json()["warning_codes"]] == ["import-points-left-out"]
    assert (await commander.delete(f"{imports}/{walk.json()['import_id']}")).status_code == 204

    path = f"{imports}/{one['import_id']}"
    (shown,) = (await commander.get(f"{path}/tracks")).json()["tracks"]
    north_m, east_m, _ = ANCHOR.to_incident_m(52.0 + 29e-6, 4.0 + 29e-6, 0.0)
    assert len(shown["points"]) == 30
    t_ms, *place_m, floor = shown["points"][-1]
    assert (t_ms, floor) == ((now_s + 29) * 1000, None)
    assert place_m == pytest.approx([north_m, east_m], abs=0.02)
    (thin,) = (await commander.get(f"{path}/tracks", params={"every_s": 10})).json()["tracks"]
    assert 3 <= len(thin["points"]) <= 4
    assert (await commander.get(f"{path}/file")).content == track
    assert (await commander.get(f"{path}/picture")).status_code == 404
    shifted = {"file_name": "drone.gpx", "shift_s": "5"}
    again = await commander.post(imports, params=shifted, content=track)
    assert "take it out first" in again.json()["detail"]

    photo = write_photo(tmp_path / "d.jpg", (52.0, 4.0), exif_time(now_s, 1.0)).read_bytes()
    camera = {"file_name": "d.jpg", "utc_offset_h": "1"}
    door = (await commander.post(imports, params=camera, content=photo)).json()
    picture = await commander.get(f"{imports}/{door['import_id']}/picture")
    assert picture.headers["content-type"] == "image/jpeg"
    assert picture.content.startswith(b"\xff\xd8")

    assert (await commander.delete(path)).status_code == 204
    assert [one["file_name"] for one in (await commander.get(imports)).json()] == ["d.jpg"]
    assert (await commander.get(f"{path}/tracks")).status_code == 404
    assert (await commander.delete(path)).status_code == 404
    back = await commander.post(imports, params=shifted, content=track)
    assert (back.status_code, back.json()["from_ms"]) == (201, (now_s + 5) * 1000)
    assert len(list((tmp_path / "imports").rglob("*.original"))) == 2


async def test_refused_file_leaves_nothing(
    station: InProcessStation,
    commander: httpx.AsyncClient,
    clock: ManualClock,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now_s = clock.utc_ns() // NS_PER_S
    incident_id = (await commander.post("/incidents", json={"name": "Mill"})).json()["incident_id"]
    await commander.put("/site/anchor", json={"lat_deg": 52.0, "lon_deg": 4.0})
    imports = f"/incidents/{incident_id}/imports"
    track = write_gpx(tmp_path / "a.gpx", "Drone", line(now_s, 30)).read_bytes()
    late = write_gpx(tmp_path / "b.gpx", "Drone", line(now_s + 9 * 3600, 30)).read_bytes()

    async def refusal(status: int, content: bytes, **headers: str) -> str:
        named = {"file_name": "a.gpx"}
        answer = await commander.post(imports, params=named, content=content, headers=headers)
        assert answer.status_code == status, answer.text
        assert not [path for path in (tmp_path / "imports").rglob("*") if path.is_file()]
        assert (await commander.get(imports)).json() == []
        return str(answer.json()["detail"])

    assert "nothing that can be brought in" in await refusal(422, b"hello")
    assert "off (by about +9.0 h)" in await refusal(422, late)
    assert "too large" in await refusal(413, b"x", **{"content-length": str(MOST_BYTES + 1)})
    usage = namedtuple("usage", "total used free")
    with monkeypatch.context() as full:
        full.setattr(shutil, "disk_usage", lambda _: usage(10**9, 10**9, 10**8))
        assert "make room first" in await refusal(503, track)
    with monkeypatch.context() as failing:

        def refuse(*_: object) -> None:
            raise StoreError("the log takes nothing")

        failing.setattr(type(station.services), "perform", refuse)
        assert "takes nothing" in await refusal(503, track)


def test_incident_of_another_station_and_a_track_are_stored(
    data: Path, other_incident: Path, tmp_path: Path
) -> None:
    t_s = opened_s(data)
    before = other_incident.read_bytes()
    track = write_gpx(tmp_path / "Ada Vos.gpx", "Drone", line(t_s, 30, 52.5))
    result = muster("import", "i1", other_incident, track, tmp_path / "none.gpx", "--data", data)
    assert result.exit_code != 0  # for the third
    assert "1 of 3 files" in str(result.exception)
    assert "none.gpx cannot be read" in result.output
    assert "begins 56 km away" in result.output
    assert other_incident.read_bytes() == before
    incident_import, track_import = ids_in(data)
    folder = ImportFolder(data / "imports")
    kept = folder.original("i1", incident_import)
    assert kept is not None
    assert kept.read_bytes() == before
    content = folder.content("i1", incident_import)
    assert content is not None
    assert [one.name for one in content.tracks] == ["Ada Vos (FF-01), Mill Lane"]
    assert len(content.tracks[0].points) >= 35

    listed = muster("import", "i1", "--data", data).output
    assert "Ada Vos.gpx" in listed  # by the roster; the log has her id
    assert muster("rebuild", "--data", data).exit_code == 0
    assert ids_in(data) == [incident_import, track_import]
    done = read_log(data / "log", keys={OPERATOR.key(STATION_ID)})
    actions = b"".join(payload for _, _, payload in done)
    assert reference_to("ada0").encode() + b".gpx" in actions
    assert b"Ada Vos.gpx" not in actions

    copy = tmp_path / "copy"
    assert muster("backup", copy, "--data", data).exit_code == 0
    assert files_in(copy) == files_in(data)
    assert len(files_in(data)) == 6
    taken_out = muster("import", "i1", "--remove", track_import, "--data", data)
    assert "taken out: Ada Vos.gpx" in taken_out.output
    assert muster("backup", copy, "--data", data).exit_code == 0
    assert files_in(copy) == files_in(data)
    assert len(files_in(data)) == 3
    assert ids_in(copy) == [incident_import]

    erased = CliRunner().invoke(app, ["forget", "i1", "--data", str(data)], input="i1\n")
    assert erased.exit_code == 0, erased.output
    assert not files_in(data)
    assert ids_in(data) == []
    left = b"".join(path.read_bytes() for path in data.rglob("*") if path.is_file())
    assert b"north.mcap" not in left
    assert muster("rebuild", "--data", data).exit_code == 0
    assert ids_in(data) == []


def answer(station: ImportRequests, waiting: threading.Thread) -> None:
    def is_answered() -> bool:
        station.answer_pending()
        return not waiting.is_alive()

    until(is_answered, "an answer")


def test_running_station_logs_the_import_of_a_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = DataFolder(tmp_path)
    done: list[ImportAction] = []
    answering = ImportRequests(folder, done.append)
    removal = RemoveImport("i1", "a")
    waiting = threading.Thread(target=requests.request_action, args=(folder, removal))
    waiting.start()
    answer(answering, waiting)
    assert done == [removal]

    def refuse(_: ImportAction) -> None:
        raise UserError("this is the standby")

    refusals: list[str] = []

    def ask() -> None:
        with pytest.raises(UserError) as refused:
            requests.request_action(folder, removal)
        refusals.append(str(refused.value))

    refusing = ImportRequests(folder, refuse)
    waiting = threading.Thread(target=ask)
    waiting.start()
    answer(refusing, waiting)
    assert refusals == ["this is the standby"]
    (tmp_path / "import-request.json").write_text("{")
    refusing.answer_pending()
    assert not list(tmp_path.iterdir())
    monkeypatch.setattr(request_files, "ANSWERED_WITHIN_S", 0.0)
    with pytest.raises(UserError, match="does not answer"):
        requests.request_action(folder, removal)
