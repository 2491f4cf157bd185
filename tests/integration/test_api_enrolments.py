"""Enrolments over the API: rights, secure connections, one delivery, and the audit."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import httpx
import pytest
import zxingcpp
from PIL import Image

from base_station.accounts.principals import Role
from base_station.security.pki.folder import PkiFolder
from base_station.storage.db.window import EVER
from shared.enrolment import Holder, parse_enrolment
from shared.errors import StoreError
from tests.rig.in_process_station import ORIGIN, InProcessStation

UNIT = {"unit_id": "FF-01"}
DAY_MS = 86_400_000


@pytest.fixture
def pki(station: InProcessStation, tmp_path: Path) -> PkiFolder:
    folder = PkiFolder(tmp_path)
    folder.create("Test", ["192.0.2.7"], ["tls/192.0.2.7:7447"])
    set_services(station, pki=folder)
    return folder


def set_services(station: InProcessStation, **what: object) -> None:
    services = dataclasses.replace(station.services, **what)  # type: ignore[arg-type]
    station.services = station.app.state.services = services


def audited(station: InProcessStation) -> list[tuple[str, str, str]]:
    entries = station.services.records.audit_entries(EVER)
    return [(entry.by, entry.action, entry.detail) for entry in entries]


def client_at(station: InProcessStation, address: str) -> httpx.AsyncClient:
    """An administrator's program at this address."""
    administrator = station.client(Role.ADMINISTRATOR)
    transport = httpx.ASGITransport(station.app, client=(address, 40_000))
    return httpx.AsyncClient(
        transport=transport, base_url=f"{ORIGIN}/api/v1", headers=administrator.headers
    )


def scanned(rows: list[str]) -> str:
    """Text of the code as a camera reads it, drawn as by the console."""
    picture = Image.new("L", (len(rows) + 8, len(rows) + 8), 255)
    for y, row in enumerate(rows):
        for x, module in enumerate(row):
            if module == "1":
                picture.putpixel((x + 4, y + 4), 0)
    large = picture.resize((picture.width * 4, picture.height * 4), Image.Resampling.NEAREST)
    (code,) = zxingcpp.read_barcodes(large)
    return str(code.text)


async def test_an_administrator_enrols_a_unit(station: InProcessStation, pki: PkiFolder) -> None:
    async with station.client(Role.ADMINISTRATOR) as client:
        answer = await client.post("/enrolments", json=UNIT)
        assert answer.status_code == 201
        assert answer.headers["cache-control"] == "no-store"
        made = answer.json()
        enrolment = parse_enrolment(made["text"])
        assert (enrolment.holder, enrolment.name) == (Holder.UNIT, "FF-01")
        assert enrolment.connect == ("tls/192.0.2.7:7447",)
        assert scanned(made["qr_rows"]) == made["text"]
        (entry,) = [one for one in pki.registry().entries if one.holder is Holder.UNIT]
        assert made["valid_to_ms"] == entry.valid_to.timestamp() * 1000
        listed = await client.get("/enrolments")
        assert listed.json() == [{"unit_id": "FF-01", "valid_to_ms": made["valid_to_ms"]}]
    assert audited(station) == [("administrator", "MadeEnrolment", "of unit FF-01")]
    assert made["text"] not in str(audited(station))


async def test_second_enrolment_is_refused_and_renewal_is_allowed(
    station: InProcessStation, pki: PkiFolder
) -> None:
    """The key is nowhere: whose answer was lost sends another request, and no key repeats one."""
    async with station.client(Role.ADMINISTRATOR) as client:
        key = {"Idempotency-Key": "k1"}
        first = (await client.post("/enrolments", json=UNIT, headers=key)).json()
        again = await client.post("/enrolments", json=UNIT, headers=key)
        assert again.status_code == 409
        assert "is enrolled until" in again.json()["detail"]
        renewed = await client.post("/enrolments", json=UNIT | {"renew": True, "days": 30})
        assert renewed.status_code == 201
    assert first["valid_to_ms"] - renewed.json()["valid_to_ms"] > 330 * DAY_MS
    assert renewed.json()["text"] != first["text"]
    assert [action for _, action, _ in audited(station)] == ["RenewedEnrolment", "MadeEnrolment"]


async def test_renewal_of_an_unknown_unit_is_refused(
    station: InProcessStation, pki: PkiFolder
) -> None:
    async with station.client(Role.ADMINISTRATOR) as client:
        answer = await client.post("/enrolments", json=UNIT | {"renew": True})
        assert answer.status_code == 409
        assert "there is no unit FF-01 with a certificate" in answer.json()["detail"]
        reserved = await client.post("/enrolments", json={"unit_id": "station"})
        assert reserved.status_code == 422
    assert audited(station) == []


async def test_a_revoked_unit_is_not_listed_and_is_enrolled_anew(
    station: InProcessStation, pki: PkiFolder
) -> None:
    pki.enroll("FF-01")
    pki.enroll("chief", Holder.OPERATOR)
    pki.revoke("FF-01")
    async with station.client(Role.ADMINISTRATOR) as client:
        assert (await client.get("/enrolments")).json() == []
        assert (await client.post("/enrolments", json=UNIT)).status_code == 201


@pytest.mark.parametrize("address", ["192.0.2.20", "2001:db8::7", "", "::ffff:192.0.2.20"])
async def test_private_key_is_not_sent_over_a_plain_network(
    station: InProcessStation, pki: PkiFolder, address: str
) -> None:
    async with client_at(station, address) as client:
        answer = await client.post("/enrolments", json=UNIT)
        assert answer.status_code == 403
        assert "serve the console over TLS" in answer.json()["detail"]
        assert pki.registry().current(Holder.UNIT, "FF-01") is None
        set_services(station, secure=True)
        assert (await client.post("/enrolments", json=UNIT)).status_code == 201


@pytest.mark.parametrize("address", ["127.0.0.1", "::1", "::ffff:127.0.0.1"])
async def test_enrolment_on_the_stations_machine_needs_no_tls(
    station: InProcessStation, pki: PkiFolder, address: str
) -> None:
    async with client_at(station, address) as client:
        assert (await client.post("/enrolments", json=UNIT)).status_code == 201


async def test_enrolment_without_an_authority_names_the_remedy(
    station: InProcessStation, tmp_path: Path
) -> None:
    set_services(station, pki=PkiFolder(tmp_path))
    async with station.client(Role.ADMINISTRATOR) as client:
        for answer in (
            await client.get("/enrolments"),
            await client.post("/enrolments", json=UNIT),
        ):
            assert answer.status_code == 409
            assert "make one with `muster pki init`" in answer.json()["detail"]
        set_services(station, pki=None)
        answer = await client.get("/enrolments")
        assert answer.status_code == 409
        assert "enrols no units now" in answer.json()["detail"]


async def test_further_station_refers_to_the_first_for_enrolments(
    station: InProcessStation, pki: PkiFolder, tmp_path: Path
) -> None:
    other = PkiFolder(tmp_path / "other")
    other.join(pki.enroll_station("b", ["192.0.2.8"], "tls/192.0.2.8:7447"))
    set_services(station, pki=other)
    async with station.client(Role.ADMINISTRATOR) as client:
        answer = await client.post("/enrolments", json=UNIT)
        assert answer.status_code == 409
        assert "at the first station alone; enrol and renew there" in answer.json()["detail"]


async def test_enrolment_that_cannot_be_audited_is_refused(
    station: InProcessStation, pki: PkiFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    def hangs(*_: object) -> None:
        raise StoreError("the disk hangs")

    monkeypatch.setattr(type(station.services.records), "audit", hangs)
    async with station.client(Role.ADMINISTRATOR) as client:
        answer = await client.post("/enrolments", json=UNIT)
    assert answer.status_code == 503
    assert "MUSTER1" not in answer.text


async def test_the_private_key_is_in_no_file_of_the_station(
    station: InProcessStation, pki: PkiFolder, tmp_path: Path
) -> None:
    async with station.client(Role.ADMINISTRATOR) as client:
        text = (await client.post("/enrolments", json=UNIT)).json()["text"]
    key = parse_enrolment(text).identity.private_key.splitlines()[1]
    files = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert tmp_path / "station.sqlite" in files
    assert [path for path in files if key in path.read_bytes()] == []
    assert [path for path in files if text[8:48].encode() in path.read_bytes()] == []
