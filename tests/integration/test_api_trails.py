"""Trails and the assessment of an incident by way of the API."""

from __future__ import annotations

import asyncio
import gzip
from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest
import pytest_asyncio

from base_station.accounts.principals import Role
from base_station.fusion.smoothing import SMOOTHERS
from base_station.replay.playback import Archive
from base_station.replay.post_processing import PostProcessor
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.smoothed import SmoothedTracks
from shared.channels import channel_of
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.messages import Header, Message, Position
from shared.messages.station import SetAnchor
from tests.rig.in_process_station import InProcessStation
from tests.rig.live_station import make_pipeline

Record = tuple[int, str, bytes]


@pytest_asyncio.fixture
async def station(tmp_path: Path, clock: ManualClock) -> AsyncIterator[InProcessStation]:
    """It keeps a log in memory of what it hears."""
    station = InProcessStation(tmp_path, clock)
    station.hub.connect(asyncio.get_running_loop(), station.drive)
    records: list[Record] = []
    receive = station.drive.receive

    def recorded(message: Message) -> object:
        key = channel_of(message).key(message.header.unit_id)
        records.append((clock.utc_ns(), key, encode(message)))
        return receive(message)

    station.drive.receive = recorded  # type: ignore[method-assign,assignment]  # beside the real one
    archive = Archive(
        lambda t_ns: [one for one in records if one[0] >= t_ns],
        Checkpoints(tmp_path / "checkpoints"),
        make_pipeline,
    )
    post_processor = PostProcessor(archive, SMOOTHERS[0], SmoothedTracks(station.store), clock)
    station.app.state.services = replace(station.services, post_processor=post_processor)
    station.hub.connect(asyncio.get_running_loop(), station.drive)
    yield station
    station.close()


async def worked(
    station: InProcessStation, clock: ManualClock, position: Position, *, closed: bool
) -> str:
    """An incident of a minute in which one unit walks north and is pinned."""
    async with station.client(Role.COMMANDER) as commander:
        await commander.post("/units", json={"unit_id": "FF-01"})
        opened = await commander.post("/incidents", json={"name": "Mill Lane"})
        start = {"north_m": 0.0, "east_m": 0.0, "heading_std_rad": 0.1}
        await commander.put("/units/FF-01/start", json=start)
        for second in range(60):
            clock.advance(1.0)
            header = Header("FF-01", 7, second + 1, second * NS_PER_S)
            walked = msgspec.structs.replace(
                position, header=header, north_m=1.0 * second, east_m=0.0
            )
            station.drive.receive(walked)
        pin = {"unit_id": "FF-01", "north_m": 58.0, "east_m": 2.0, "std_m": 0.5}
        assert (await commander.post("/pins", json=pin)).status_code == 201
        incident_id: str = opened.json()["incident_id"]
        if closed:
            clock.advance(1.0)
            closed_as = await commander.post(f"/incidents/{incident_id}/close")
            assert closed_as.status_code == 204
        return incident_id


@pytest.mark.parametrize("closed", [True, False])
async def test_raw_shown_and_smoothed_trails_are_served(
    station: InProcessStation, clock: ManualClock, make_position, closed: bool
) -> None:
    incident_id = await worked(station, clock, make_position(), closed=closed)
    async with station.client(Role.VIEWER) as viewer:
        last = {}
        for kind in ("raw", "fused", "smoothed"):
            answer = await viewer.get(f"/incidents/{incident_id}/trails", params={"kind": kind})
            assert answer.status_code == 200, answer.text
            body = answer.json()
            assert (body["incident_id"], body["kind"]) == (incident_id, kind)
            (trail,) = body["trails"]
            assert trail["unit_id"] == "FF-01"
            assert len(trail["points"]) > 30
            last[kind] = trail["points"][-3]
        assert last["smoothed"][2] > 1.0 > abs(last["fused"][2])
        few = await viewer.get(
            f"/incidents/{incident_id}/trails", params={"kind": "smoothed", "every_s": 30}
        )
        assert len(few.json()["trails"][0]["points"]) <= 4


async def test_smoothed_trail_is_assessed_and_exported(
    station: InProcessStation, clock: ManualClock, make_position
) -> None:
    incident_id = await worked(station, clock, make_position(), closed=True)
    station.drive.submit("chief", SetAnchor(52.0, 4.0, 0.0, 0.0))
    async with station.client(Role.VIEWER) as viewer:
        answer = await viewer.get(f"/incidents/{incident_id}/assessment")
        assert answer.status_code == 200, answer.text
        (unit,) = answer.json()["units"]
        assert unit["stated"]["ce50_m"] < unit["stated"]["ce95_m"]
        (residual,) = unit["pin_residuals"]
        assert residual["used"]
        files = [
            await viewer.get(f"/incidents/{incident_id}/export/csv", params={"kind": kind})
            for kind in ("fused", "smoothed")
        ]
        assert all(file.status_code == 200 for file in files)
        assert files[0].content != files[1].content


async def test_incident_without_received_units_has_no_trails(
    station: InProcessStation,
) -> None:
    """And pins that wait: the smoother is not asked about nobody."""
    async with station.client(Role.COMMANDER) as commander:
        await commander.post("/units", json={"unit_id": "FF-01"})
        opened = await commander.post("/incidents", json={"name": "Mill Lane"})
        incident_id = opened.json()["incident_id"]
        pin = {"unit_id": "FF-01", "north_m": 58.0, "east_m": 2.0, "std_m": 0.5}
        assert (await commander.post("/pins", json=pin)).status_code == 201
        for kind in ("raw", "fused", "smoothed"):
            answer = await commander.get(f"/incidents/{incident_id}/trails", params={"kind": kind})
            assert answer.status_code == 200, answer.text
            assert answer.json()["trails"] == []
        report = await commander.get(f"/incidents/{incident_id}/assessment")
        assert report.status_code == 200, report.text
        assert report.json()["units"] == []


async def test_invalid_request_is_refused_with_a_reason(station: InProcessStation) -> None:
    async with station.client(Role.VIEWER) as viewer:
        for path in ("trails", "assessment"):
            assert (await viewer.get(f"/incidents/none/{path}")).status_code == 404
        odd = await viewer.get("/incidents/none/trails", params={"kind": "dreamt"})
        assert odd.status_code == 422


async def test_station_without_a_log_refuses_trails(tmp_path: Path, clock: ManualClock) -> None:
    station = InProcessStation(tmp_path, clock)
    station.hub.connect(asyncio.get_running_loop(), station.drive)
    async with station.client(Role.COMMANDER) as commander:
        opened = await commander.post("/incidents", json={"name": "Mill Lane"})
        path = f"/incidents/{opened.json()['incident_id']}/trails"
        answer = await commander.get(path, params={"kind": "smoothed"})
        assert answer.status_code == 503
        assert "no log" in answer.json()["detail"]
    station.close()


async def test_result_is_marked_as_outdated_until_recomputed(
    station: InProcessStation, clock: ManualClock, make_position
) -> None:
    incident_id = await worked(station, clock, make_position(), closed=True)
    async with station.client(Role.COMMANDER) as commander:
        asked = f"/incidents/{incident_id}/trails?kind=smoothed", f"/incidents/{incident_id}"

        async def newest() -> tuple[bool, list[object]]:
            trails = (await commander.get(asked[0])).json()
            report = (await commander.get(f"{asked[1]}/assessment")).json()
            assert trails["is_newest"] == report["is_newest"]
            return trails["is_newest"], trails["trails"]

        is_newest, first = await newest()
        assert is_newest
        closed_ms = (await commander.get(asked[1])).json()["closed_ms"]
        clock.advance(60.0)
        pin = {"unit_id": "FF-01", "t_ms": closed_ms - 30_000, "north_m": 30.0, "east_m": -2.0}
        assert (await commander.post("/pins", json=pin | {"std_m": 0.5})).status_code == 201
        assert await newest() == (False, first)
        clock.advance(31.0)
        is_newest, again = await newest()
        assert is_newest
        assert again != first


async def test_exported_file_names_its_kind_of_trail(
    station: InProcessStation, clock: ManualClock, make_position
) -> None:
    """Saved beside each other, days later they cannot be told apart otherwise."""
    incident_id = await worked(station, clock, make_position(), closed=True)
    async with station.client(Role.COMMANDER) as commander:
        anchor = {"lat_deg": 52.0, "lon_deg": 4.0, "height_m": 0.0, "plan_rotation_rad": 0.0}
        assert (await commander.put("/site/anchor", json=anchor)).is_success
        saved = {
            kind: await commander.get(f"/incidents/{incident_id}/export/gpx", params={"kind": kind})
            for kind in ("fused", "smoothed", "raw")
        }
        path = f"/incidents/{incident_id}/export"
        packed = await commander.get(f"{path}/gpx", params={"gzip": True})
        plain = await commander.get(f"{path}/gpx", headers={"Accept-Encoding": "gzip;q=0, br"})
        table = await commander.get(f"{path}/parquet")
    assert packed.headers["content-disposition"].endswith('.gpx.gz"')
    assert gzip.decompress(packed.content) == saved["fused"].content == plain.content
    assert saved["fused"].headers["content-encoding"] == "gzip"
    assert not {"content-encoding"} & (set(plain.headers) | set(table.headers))
    names = [answer.headers["content-disposition"] for answer in saved.values()]
    assert names == [
        f'attachment; filename="{incident_id}.gpx"',
        f'attachment; filename="{incident_id}-smoothed.gpx"',
        f'attachment; filename="{incident_id}-raw.gpx"',
    ]
    assert "<name>Mill Lane, as it was shown</name>" in saved["fused"].text
    assert "<name>Mill Lane, as it is known afterwards</name>" in saved["smoothed"].text
    assert "<name>Mill Lane, by the units' own paths alone</name>" in saved["raw"].text
