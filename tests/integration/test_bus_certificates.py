"""Connections to the bus, over Zenoh: every certificate but the right one is refused."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from cryptography import x509

from base_station.security.pki.folder import PkiFolder
from shared.bus_zenoh import ClientEndpoint, UnitEndpoint, ZenohBus
from shared.channels import (
    POSITION,
    Qos,
)
from shared.enrolment import Enrolment
from shared.errors import BusError
from shared.tls import TlsIdentity
from tests.rig.secured_bus import QUIET_S, Site, assert_never_linked, publish_until_received
from tests.rig.waiting import until


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    with ExitStack() as stack:
        yield Site(tmp_path, stack)


def test_expired_certificate_is_refused(site: Site, tmp_path: Path) -> None:
    then = datetime.now(UTC) - timedelta(hours=20)  # the authority is backdated by a day
    expired = PkiFolder(tmp_path, lambda: then).enroll("anna", valid=timedelta(hours=12))
    site.open()
    assert_never_linked(site, UnitEndpoint(expired.connect, expired.identity))


def test_a_link_ends_with_its_certificate(site: Site) -> None:
    enrolment = site.pki.enroll("anna", valid=timedelta(seconds=4))
    site.open()
    unit = site.unit(enrolment)
    publish_until_received(site, unit, "anna")
    until(lambda: datetime.now(UTC) > ends(enrolment), "the end of the certificate")
    until(lambda: not unit.is_linked(), "the end of the link")
    site.received.clear()
    unit.publish(POSITION.key("anna"), b"late", Qos.LIVE)
    time.sleep(QUIET_S)
    assert site.received == []


def test_a_certificate_of_another_authority_is_refused(site: Site, tmp_path: Path) -> None:
    elsewhere = PkiFolder(tmp_path / "elsewhere")
    elsewhere.create("Test", hosts=[], connect=[f"tls/{site.address}"])
    foreign = elsewhere.enroll("anna")
    own = site.pki.enroll("anna")
    site.open()
    assert_never_linked(site, UnitEndpoint(foreign.connect, foreign.identity))
    # It trusts the station, but is not of its authority.
    mixed = TlsIdentity(
        own.identity.authority, foreign.identity.certificate, foreign.identity.private_key
    )
    assert_never_linked(site, UnitEndpoint(own.connect, mixed))


def test_a_station_of_another_authority_is_refused_by_the_unit(site: Site, tmp_path: Path) -> None:
    elsewhere = PkiFolder(tmp_path / "elsewhere")
    elsewhere.create("Test", hosts=[], connect=[f"tls/{site.address}"])
    foreign = elsewhere.enroll("anna")
    own = site.pki.enroll("anna")
    site.open()
    trusting_another = TlsIdentity(
        foreign.identity.authority, own.identity.certificate, own.identity.private_key
    )
    assert_never_linked(site, UnitEndpoint(own.connect, trusting_another))


def test_unit_refuses_a_station_of_another_host_name(site: Site) -> None:
    own = site.pki.enroll("anna")
    site.open()
    assert_never_linked(site, UnitEndpoint((f"tls/{site.unnamed_address}",), own.identity))


def test_plain_tcp_is_refused(site: Site) -> None:
    site.pki.enroll("anna")
    site.open()
    assert_never_linked(site, UnitEndpoint((f"tcp/{site.address}",)))


def test_a_client_without_a_certificate_is_refused(site: Site) -> None:
    import ssl  # noqa: PLC0415  # Zenoh itself will not open without one

    site.open()
    context = ssl.create_default_context(
        cadata=site.pki.station_identity().authority.decode("ascii")
    )
    host, _, port = site.address.partition(":")
    with (
        socket.create_connection((host, int(port)), 5.0) as plain,
        context.wrap_socket(plain, server_hostname=host) as secured,
        pytest.raises(ssl.SSLError, match="CERTIFICATE_REQUIRED"),
    ):
        secured.recv(1)


def test_missing_router_is_reported_with_its_address(site: Site) -> None:
    endpoint = ClientEndpoint((f"tls/{site.address}",), site.pki.station_identity(), patience_s=0.3)
    with pytest.raises(BusError, match=site.address):
        ZenohBus(endpoint)


def ends(enrolment: Enrolment) -> datetime:
    certificate = x509.load_pem_x509_certificate(enrolment.identity.certificate)
    return certificate.not_valid_after_utc
