"""The authority's folder: issued and kept files, refusals, and file modes."""

from __future__ import annotations

import errno
import itertools
import os
import stat
from datetime import UTC, datetime, timedelta
from pathlib import Path
from threading import Event, Thread

import pytest
from cryptography import x509
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from base_station.security.pki.certificates import make_authority
from base_station.security.pki.expiry import (
    ConsoleExpiry,
    ExpiryWatch,
    about_to_expire,
    not_yet_valid,
)
from base_station.security.pki.folder import CERTIFICATE_VALID, PkiFolder
from base_station.security.pki.renewal import Renewal
from base_station.storage.private_files import locked
from shared.clock import NS_PER_S, ManualClock
from shared.enrolment import Enrolment, Holder
from shared.errors import ConfigError, StoreError
from shared.tls import check_identity, validity_problem

DAY = timedelta(days=1)


class Clock:
    def __init__(self) -> None:
        self.now = datetime(2026, 3, 1, 12, tzinfo=UTC)

    def __call__(self) -> datetime:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def pki(tmp_path: Path, clock: Clock) -> PkiFolder:
    folder = PkiFolder(tmp_path, clock)
    folder.create("Test", ["station.local", "192.0.2.7"], ["tls/station.local:7447"])
    return folder


def certificate(enrolment: Enrolment) -> x509.Certificate:
    return x509.load_pem_x509_certificate(enrolment.identity.certificate)


def common_name(of: x509.Certificate) -> str:
    return str(of.subject.get_attributes_for_oid(NameOID.COMMON_NAME)[0].value)


@pytest.mark.parametrize("refused", [1, 2, 3])
def test_full_disk_leaves_a_certificate_and_its_key_together(
    pki: PkiFolder, monkeypatch: pytest.MonkeyPatch, refused: int
) -> None:
    """A station that is renewed then must still start the next time."""
    before = pki.station_identity()
    calls = itertools.count(1)

    def full(descriptor: int) -> None:
        if next(calls) >= refused:
            raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as disk:
        disk.setattr("base_station.storage.private_files.os.fsync", full)
        with pytest.raises(StoreError, match="No space left"):
            pki.renew_station()
    after = pki.station_identity()  # which says where the two do not belong together
    assert refused == 3 or after == before
    assert not list(pki.path.glob("*.partial"))


def test_kept_files_are_unreadable_for_others(pki: PkiFolder) -> None:
    assert stat.S_IMODE(pki.path.stat().st_mode) == 0o700
    pki.enroll("anna")
    pki.renew_station()
    for file in pki.path.iterdir():
        assert stat.S_IMODE(file.stat().st_mode) == 0o600, file.name
    assert {file.name for file in pki.path.iterdir()} == {
        "authority.key", "authority.pem", "lock", "registry.json", "station.key", "station.pem",
    }  # fmt: skip


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give files away")
def test_files_made_by_root_belong_to_the_station(tmp_path: Path) -> None:
    os.chown(tmp_path, 12345, 12345)
    pki = PkiFolder(tmp_path)
    pki.create("Test", [], ["tls/127.0.0.1:7447"])
    pki.enroll("anna")
    pki.renew_station()
    assert {path.stat().st_uid for path in (pki.path, *pki.path.iterdir())} == {12345}


def test_one_command_at_a_time_changes_the_folder(pki: PkiFolder) -> None:
    enrolled = Event()

    def enrol() -> None:
        pki.enroll("bert")
        enrolled.set()

    with locked(pki.path):
        other = Thread(target=enrol)
        other.start()
        assert not enrolled.wait(0.2)
    other.join()
    assert pki.registry().current(Holder.UNIT, "bert") is not None


def test_unwritable_folder_is_reported(pki: PkiFolder) -> None:
    (pki.path / "registry.json.partial").mkdir()
    with pytest.raises(StoreError, match=r"registry\.json cannot be written"):
        pki.enroll("anna")


def test_unreadable_folder_is_reported(pki: PkiFolder, tmp_path: Path) -> None:
    pki.registry_path.unlink()
    pki.registry_path.mkdir()
    with pytest.raises(ConfigError, match=r"registry\.json cannot be read: .*directory"):
        pki.registry()
    with pytest.raises(StoreError, match="nowhere cannot be used: No such file"):
        locked(tmp_path / "nowhere").__enter__()
    (tmp_path / "file").touch()
    with pytest.raises(StoreError, match="pki cannot be made: File exists"):
        PkiFolder(tmp_path / "file").create("Test", [], [])


def test_station_certificate_has_its_hosts_and_the_loopback(pki: PkiFolder) -> None:
    own = x509.load_pem_x509_certificate(pki.station_identity().certificate)
    names = own.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    assert names.get_values_for_type(x509.DNSName) == ["station.local", "localhost"]
    assert [str(one) for one in names.get_values_for_type(x509.IPAddress)] == [
        "192.0.2.7", "127.0.0.1", "::1",
    ]  # fmt: skip


def test_unit_cannot_pose_as_a_station_or_an_authority(pki: PkiFolder) -> None:
    extensions = certificate(pki.enroll("anna")).extensions
    uses = extensions.get_extension_for_class(x509.ExtendedKeyUsage).value
    assert list(uses) == [ExtendedKeyUsageOID.CLIENT_AUTH]
    assert not extensions.get_extension_for_class(x509.BasicConstraints).value.ca
    assert not extensions.get_extension_for_class(x509.KeyUsage).value.key_cert_sign


def test_authority_signs_certificates_and_no_further_authority(pki: PkiFolder) -> None:
    extensions = x509.load_pem_x509_certificate(
        (pki.path / "authority.pem").read_bytes()
    ).extensions
    constraints = extensions.get_extension_for_class(x509.BasicConstraints).value
    assert (constraints.ca, constraints.path_length) == (True, 0)
    usage = extensions.get_extension_for_class(x509.KeyUsage).value
    assert (usage.key_cert_sign, usage.digital_signature) == (True, False)


def test_certificate_is_valid_for_a_clock_behind_by_less_than_a_day(
    pki: PkiFolder, clock: Clock
) -> None:
    identity = pki.enroll("anna").identity
    assert validity_problem(identity, clock.now - 0.99 * DAY) is None
    assert "set the clock" in str(validity_problem(identity, clock.now - 1.01 * DAY))


def test_enrolment_is_consistent_and_has_the_address_of_the_station(
    pki: PkiFolder, clock: Clock
) -> None:
    enrolment = pki.enroll("anna", valid=10 * DAY)
    check_identity(enrolment.identity)
    assert (enrolment.holder, enrolment.name) == (Holder.UNIT, "anna")
    assert enrolment.connect == ("tls/station.local:7447",)
    assert common_name(certificate(enrolment)) == "anna"
    assert validity_problem(enrolment.identity, clock.now + 10 * DAY) is None
    assert "expired on" in str(validity_problem(enrolment.identity, clock.now + 10.1 * DAY))
    elsewhere = pki.enroll("bert", connect=["tls/192.0.2.9:1"])
    assert elsewhere.connect == ("tls/192.0.2.9:1",)


def test_key_of_a_unit_is_not_kept(pki: PkiFolder) -> None:
    secret = pki.enroll("anna").identity.private_key.splitlines()[1]
    assert not any(secret in file.read_bytes() for file in pki.path.iterdir())


def test_station_folder_made_with_it_is_readable_by_its_owner_alone(tmp_path: Path) -> None:
    before = os.umask(0o022)
    try:
        PkiFolder(tmp_path / "station").create("Test", [], [])
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "station").stat().st_mode) == 0o700


def test_interrupted_initialisation_begins_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ended(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr("base_station.security.pki.folder.write_together", ended)
        with pytest.raises(KeyboardInterrupt):
            PkiFolder(tmp_path).create("Test", [], [])
    PkiFolder(tmp_path).create("Test", [], [])


def test_second_authority_is_refused(pki: PkiFolder, tmp_path: Path) -> None:
    before = (pki.path / "authority.pem").read_bytes()
    with pytest.raises(ConfigError, match="is there already"):
        PkiFolder(tmp_path).create("Other", [], [])
    assert (pki.path / "authority.pem").read_bytes() == before


def test_missing_authority_error_tells_how_to_make_one(tmp_path: Path) -> None:
    for act in (lambda p: p.enroll("anna"), lambda p: p.revoke("anna"), PkiFolder.registry):
        with pytest.raises(ConfigError, match="muster pki init"):
            act(PkiFolder(tmp_path))


@pytest.mark.parametrize(
    ("organisation", "days"), [("x" * 60, 365), ("Test", 3651)], ids=["name", "days"]
)
def test_failed_authority_leaves_nothing_behind(
    tmp_path: Path, organisation: str, days: int
) -> None:
    pki = PkiFolder(tmp_path)
    with pytest.raises(ConfigError, match=r"does not fit a certificate|outlive its authority"):
        pki.create(organisation, [], [], days * DAY)
    pki.create("Test", [], [], 3650 * DAY)  # as long as the authority itself


@pytest.mark.parametrize("refused", range(1, 5))
def test_full_disk_leaves_no_partial_authority(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, refused: int
) -> None:
    calls = itertools.count(1)

    def full(descriptor: int) -> None:
        if next(calls) >= refused:
            raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as disk:
        disk.setattr("base_station.storage.private_files.os.fsync", full)
        with pytest.raises(StoreError, match="No space left"):
            PkiFolder(tmp_path).create("Test", [], [])
    PkiFolder(tmp_path).create("Test", [], [])


def test_rest_of_a_power_cut_is_reported_as_such(pki: PkiFolder) -> None:
    pki.registry_path.unlink()
    with pytest.raises(ConfigError, match=r"registry\.json is missing.*move its folder away"):
        pki.create("Test", [], [])


@pytest.mark.parametrize("name", ["", "all", "station", "a/b", "a*", "-a", "a b", "é"])
def test_name_that_cannot_stand_in_a_key_is_refused(pki: PkiFolder, name: str) -> None:
    with pytest.raises(ConfigError, match="cannot be used"):
        pki.enroll(name)
    assert len(pki.registry().entries) == 1  # the station


def test_second_enrolment_is_refused(pki: PkiFolder) -> None:
    pki.enroll("anna")
    with pytest.raises(ConfigError, match="anna is enrolled until 2027-03-01; renew it"):
        pki.enroll("anna")


def test_operator_may_have_the_name_of_a_unit(pki: PkiFolder) -> None:
    pki.enroll("anna")
    operator = pki.enroll("anna", Holder.OPERATOR)
    assert common_name(certificate(operator)) == "operator:anna"
    pki.revoke("anna", Holder.OPERATOR)
    assert pki.registry().current(Holder.UNIT, "anna") is not None


def test_revoked_name_gets_another_common_name(pki: PkiFolder, clock: Clock) -> None:
    names = []
    for _ in range(3):
        names.append(common_name(certificate(pki.enroll("anna"))))
        pki.revoke("anna")
    assert names == ["anna", "anna#2", "anna#3"]
    revoked = [e.revoked for e in pki.registry().entries if e.name == "anna"]
    assert revoked == [clock.now] * 3


def test_revocation_of_an_unknown_name_lists_the_enrolled_ones(pki: PkiFolder) -> None:
    with pytest.raises(ConfigError, match="no unit anna with a certificate; none is enrolled"):
        pki.revoke("anna")
    pki.enroll("bert")
    with pytest.raises(ConfigError, match="enrolled are bert"):
        pki.revoke("anna")
    pki.revoke("bert")
    with pytest.raises(ConfigError, match="none is enrolled"):
        pki.renew("bert")


def test_renewal_keeps_the_common_name_and_changes_the_key(pki: PkiFolder, clock: Clock) -> None:
    first = pki.enroll("anna")
    clock.now += 100 * DAY
    second = pki.renew("anna")
    assert common_name(certificate(second)) == "anna"
    assert second.identity.private_key != first.identity.private_key
    entry = pki.registry().current(Holder.UNIT, "anna")
    assert entry is not None
    assert entry.serial == f"{certificate(second).serial_number:x}"
    assert len(pki.registry().entries) == 2


def test_station_is_renewed_for_other_hosts(pki: PkiFolder) -> None:
    before = pki.station_identity()
    pki.renew_station(hosts=["192.0.2.8"], connect=["tls/192.0.2.8:7447"])
    assert pki.station_identity().private_key != before.private_key
    assert pki.registry().hosts == ("192.0.2.8", "localhost", "127.0.0.1", "::1")
    assert pki.enroll("anna").connect == ("tls/192.0.2.8:7447",)


def test_certificate_does_not_outlive_its_authority(pki: PkiFolder, clock: Clock) -> None:
    clock.now += 3600 * DAY
    with pytest.raises(ConfigError, match="outlive its authority"):
        pki.enroll("anna")
    pki.enroll("anna", valid=10 * DAY)


@pytest.mark.parametrize("name", ["authority.pem", "authority.key", "registry.json"])
def test_damaged_file_is_named(pki: PkiFolder, name: str) -> None:
    path = pki.path / name
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.raises(ConfigError, match="damaged"):
        pki.enroll("anna")


def test_key_of_another_authority_issues_nothing(pki: PkiFolder, clock: Clock) -> None:
    other = make_authority("Other", clock.now, DAY)
    (pki.path / "authority.key").write_bytes(other.key_pem())
    with pytest.raises(ConfigError, match="does not belong to its certificate"):
        pki.enroll("anna")
    assert pki.registry().current(Holder.UNIT, "anna") is None


def test_missing_authority_key_is_named(pki: PkiFolder) -> None:
    (pki.path / "authority.key").unlink()
    with pytest.raises(ConfigError, match=r"authority\.key is missing; put it back"):
        pki.enroll("anna")


def test_station_files_that_do_not_match_are_reported_with_the_remedy(pki: PkiFolder) -> None:
    path = pki.path / "station.key"
    path.write_bytes((pki.path / "authority.key").read_bytes())
    with pytest.raises(ConfigError, match="renew-station"):
        pki.station_identity()
    pki.renew_station()
    pki.station_identity()


def test_expiring_certificates_are_listed_in_order_of_their_end(
    pki: PkiFolder, clock: Clock
) -> None:
    pki.enroll("anna", valid=20 * DAY)
    pki.enroll("bert", valid=5 * DAY)
    pki.enroll("chief", Holder.OPERATOR, valid=12 * DAY)
    pki.enroll("lost", valid=5 * DAY)
    pki.revoke("lost")
    clock.now += 11.5 * DAY

    def reported(within: timedelta) -> tuple[str, ...]:
        return about_to_expire(pki.registry(), clock.now, within, pki.own_common_name())

    assert reported(5 * DAY) == (
        "The certificate of unit bert expired on 2026-03-06: muster pki renew bert",
        "The certificate of operator chief expires in less than a day: "
        "muster pki renew --operator chief",
    )
    assert len(reported(10 * DAY)) == 3
    assert reported(400 * DAY)[-1].startswith("The certificate of this station expires in 353 days")


def test_nothing_is_issued_while_the_clock_is_not_set(
    pki: PkiFolder, clock: Clock, tmp_path: Path
) -> None:
    clock.now = datetime(1970, 1, 1, 0, 5, tzinfo=UTC)
    with pytest.raises(ConfigError, match=r"clock is at 1970-01-01.*set the clock"):
        pki.enroll("anna")
    with pytest.raises(ConfigError, match=r"clock is at 1970-01-01: set it first"):
        PkiFolder(tmp_path / "new", clock).create("x", [], [])


def test_station_reports_a_certificate_invalid_by_its_clock(pki: PkiFolder, clock: Clock) -> None:
    pki.require_valid_station()
    begins, clock.now = clock.now, clock.now - 3 * DAY
    with pytest.raises(ConfigError, match=r"not valid before .*: set the clock"):
        pki.require_valid_station()
    clock.now = begins + 366 * DAY
    with pytest.raises(ConfigError, match=r"expired on .*muster pki renew-station"):
        pki.require_valid_station()


@pytest.mark.parametrize("behind", [timedelta(days=2), timedelta(days=365 * 50)])
def test_clock_behind_the_certificates_is_reported(
    pki: PkiFolder, clock: Clock, behind: timedelta
) -> None:
    assert not_yet_valid(pki.registry(), clock.now) == ()
    (reported,) = not_yet_valid(pki.registry(), clock.now - behind)
    assert reported.startswith(f"This machine's clock is at {clock.now - behind:%Y-%m-%d}")
    assert "set it" in reported


def test_station_checks_for_expiring_certificates_now_and_then(
    pki: PkiFolder, tmp_path: Path
) -> None:
    clock = ManualClock(utc_ns=int(datetime(2027, 2, 20, tzinfo=UTC).timestamp()) * NS_PER_S)
    watch = ExpiryWatch(pki, clock)
    (before,) = watch.problems()
    assert before.startswith("The certificate of this station expires in 9 days")
    pki.registry_path.write_bytes(b"{")
    assert watch.problems() == (before,)
    clock.advance(61.0)
    assert "damaged" in watch.problems()[0]
    assert ExpiryWatch(PkiFolder(tmp_path / "plain"), clock).problems() == ()


def test_end_of_a_foreign_console_certificate_is_reported(pki: PkiFolder, tmp_path: Path) -> None:
    clock = ManualClock(utc_ns=int(datetime(2027, 2, 20, tzinfo=UTC).timestamp()) * NS_PER_S)
    served = tmp_path / "console.pem"
    served.write_bytes((pki.path / "station.pem").read_bytes())
    assert ConsoleExpiry(served, pki, clock).problems() == ()  # the registry has this one
    elsewhere = PkiFolder(tmp_path / "plain")
    (reported,) = ConsoleExpiry(served, elsewhere, clock).problems()
    assert reported.startswith(
        "The certificate of the console expires in 9 days: put another one into"
    )
    assert str(served) in reported
    clock.advance(-30 * 86_400.0)
    assert ConsoleExpiry(served, elsewhere, clock).problems() == ()
    clock.advance(60 * 86_400.0)
    assert (
        "of the console expired on 2027-03-"
        in ConsoleExpiry(served, elsewhere, clock).problems()[0]
    )
    assert ConsoleExpiry(None, elsewhere, clock).problems() == ()
    served.write_bytes(b"rubbish")
    assert ConsoleExpiry(served, elsewhere, clock).problems() == ()


def test_renewed_certificate_is_loaded_without_open_incident_or_at_the_end_of_the_old_one(
    pki: PkiFolder, clock: Clock
) -> None:
    machine = ManualClock(round(clock.now.timestamp() * NS_PER_S))
    renewal = Renewal(pki, pki.station_identity(), machine)
    assert not renewal.is_due(in_incident=False)
    clock.now += DAY
    machine.advance(DAY.total_seconds())
    pki.renew_station()
    assert not renewal.is_due(in_incident=True)
    (reported,) = renewal.problems()
    assert "2027-03-01" in reported
    assert renewal.is_due(in_incident=False)
    assert renewal.problems() == ()
    machine.advance((CERTIFICATE_VALID - DAY - timedelta(minutes=30)).total_seconds())
    assert renewal.is_due(in_incident=True)
    (pki.path / "station.pem").write_text("no certificate")
    assert not renewal.is_due(in_incident=False), "a station that runs is better than none"
    assert not Renewal(pki, None, machine).is_due(in_incident=False)
