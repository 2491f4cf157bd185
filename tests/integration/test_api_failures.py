"""What the station cannot do is told to who asked, and stands in its log."""

from __future__ import annotations

import pytest

from base_station.db.principals import Role
from base_station.db.records import Records
from shared.errors import LogError, MusterError, StoreError
from tests.station import DeskStation


@pytest.mark.parametrize("error", [StoreError("the disk is full"), LogError("a segment is torn")])
async def test_a_failure_of_the_station_is_503_and_logged(
    station: DeskStation,
    error: MusterError,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(Records, "incidents", fail)
    async with station.client(Role.VIEWER) as viewer:
        answer = await viewer.get("/incidents")
    assert answer.status_code == 503
    assert answer.json()["detail"] == str(error)
    assert f"GET /api/v1/incidents: {error}" in caplog.text


async def test_a_table_that_is_gone_is_a_failure_of_the_station(station: DeskStation) -> None:
    with station.store.write() as session:
        session.connection().exec_driver_sql("DROP TABLE incidents")
    async with station.client(Role.VIEWER) as viewer:
        answer = await viewer.get("/incidents")
    assert answer.status_code == 503
    assert "the database cannot be read" in answer.json()["detail"]
