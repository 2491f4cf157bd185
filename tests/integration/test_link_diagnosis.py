"""Reasons of a missing link, in one sentence each, against a router."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path
from threading import Thread

import pytest

from base_station.security.pki.access import access_control
from base_station.security.pki.folder import PkiFolder
from shared.bus_zenoh import StationEndpoint, ZenohBus
from shared.enrolment import Enrolment
from shared.link_diagnosis import link_failure_reason
from shared.tls import TlsIdentity
from tests.rig.station_process import free_port


@pytest.fixture
def now() -> datetime:
    return datetime.now(UTC)


@pytest.fixture
def pki(tmp_path: Path) -> PkiFolder:
    folder = PkiFolder(tmp_path)
    folder.create("Test", hosts=[], connect=[f"tls/127.0.0.1:{free_port()}"])
    return folder


@pytest.fixture
def anna(pki: PkiFolder) -> Enrolment:
    return pki.enroll("anna")


@pytest.fixture
def foreign(tmp_path: Path, anna: Enrolment) -> Enrolment:
    elsewhere = PkiFolder(tmp_path / "elsewhere")
    elsewhere.create("Test", hosts=[], connect=anna.connect)
    return elsewhere.enroll("anna")


@pytest.fixture
def router(pki: PkiFolder, anna: Enrolment) -> Iterator[None]:
    unnamed = anna.connect[0].replace("127.0.0.1", "127.0.0.2")
    endpoint = StationEndpoint(
        (*anna.connect, unnamed), pki.station_identity(), access_control(pki.registry())
    )
    with closing(ZenohBus(endpoint)):
        yield


def test_closed_port_is_diagnosed(anna: Enrolment, now: datetime) -> None:
    reported = link_failure_reason(anna.connect, anna.identity, now)
    assert "nothing listens on port" in reported
    assert "does the station run?" in reported


@pytest.mark.usefixtures("router")
def test_working_link_is_diagnosed(anna: Enrolment, now: datetime) -> None:
    assert "the link should come by itself" in link_failure_reason(anna.connect, anna.identity, now)


@pytest.mark.usefixtures("router")
def test_station_of_another_authority_is_diagnosed(foreign: Enrolment, now: datetime) -> None:
    reported = link_failure_reason(foreign.connect, foreign.identity, now)
    assert "is not the one that enrolled this unit" in reported


@pytest.mark.usefixtures("router")
def test_certificate_of_an_unknown_authority_is_diagnosed(
    anna: Enrolment, foreign: Enrolment, now: datetime
) -> None:
    mixed = TlsIdentity(
        anna.identity.authority, foreign.identity.certificate, foreign.identity.private_key
    )
    reported = link_failure_reason(anna.connect, mixed, now)
    assert "enrol at this station" in reported
    assert "the station" in reported


@pytest.mark.usefixtures("router")
def test_certificate_without_the_address_is_diagnosed(anna: Enrolment, now: datetime) -> None:
    unnamed = anna.connect[0].replace("127.0.0.1", "127.0.0.2")
    reported = link_failure_reason([unnamed], anna.identity, now)
    assert "does not stand for 127.0.0.2" in reported
    assert "renew-station --host 127.0.0.2" in reported


@pytest.mark.usefixtures("router")
def test_expired_certificate_is_diagnosed(pki: PkiFolder, now: datetime) -> None:
    then = now - timedelta(hours=20)  # since the authority's beginning, which is backdated
    old = PkiFolder(pki.path.parent, lambda: then).enroll("bert", valid=timedelta(hours=12))
    assert "expired on" in link_failure_reason(old.connect, old.identity, now)
    behind = now - timedelta(hours=10)  # this unit's clock
    assert "the station says" in link_failure_reason(old.connect, old.identity, behind)


def test_own_clock_behind_is_diagnosed(anna: Enrolment, now: datetime) -> None:
    reported = link_failure_reason(anna.connect, anna.identity, datetime(1970, 1, 1, tzinfo=UTC))
    assert "is not valid before" in reported
    assert "1970-01-01" in reported


@pytest.mark.usefixtures("router")
def test_missing_enrolment_is_diagnosed(anna: Enrolment, now: datetime) -> None:
    assert "wants an enrolment" in link_failure_reason(anna.connect, None, now)


def test_unknown_host_name_is_diagnosed(anna: Enrolment, now: datetime) -> None:
    reported = link_failure_reason(["tls/station.invalid:7447"], anna.identity, now)
    assert "the name station.invalid is not known" in reported


def test_server_without_tls_is_diagnosed(anna: Enrolment, now: datetime) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()

        def answer() -> None:
            connection, _ = other.accept()
            with connection:
                connection.recv(10)
                connection.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")

        thread = Thread(target=answer)
        thread.start()
        port = other.getsockname()[1]
        reported = link_failure_reason([f"tls/127.0.0.1:{port}"], anna.identity, now)
        thread.join()
    assert "does not speak TLS" in reported
