"""A second station of the same authority."""

from __future__ import annotations

import errno
import re
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from base_station.security.pki.access import access_control
from base_station.security.pki.expiry import about_to_expire
from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.station_enrolment import read_station_enrolment
from shared.enrolment import Holder
from shared.errors import ConfigError, StoreError
from shared.tls import parse_certificate

FIRST, SECOND = "tls/10.0.0.1:7447", "tls/10.0.0.2:7447"


@pytest.fixture
def first(tmp_path: Path) -> PkiFolder:
    folder = PkiFolder(tmp_path / "first")
    folder.create("Test", ["10.0.0.1"], [FIRST])
    return folder


@pytest.fixture
def second(first: PkiFolder, tmp_path: Path) -> PkiFolder:
    file = tmp_path / "second.station.toml"
    first.enroll_station("second", ["10.0.0.2"], SECOND).write(file)
    assert file.stat().st_mode & 0o077 == 0
    folder = PkiFolder(tmp_path / "second")
    folder.join(read_station_enrolment(file))
    return folder


def test_second_station_has_its_own_certificate_for_its_address(
    first: PkiFolder, second: PkiFolder
) -> None:
    one, other = first.station_identity(), second.station_identity()
    assert one.authority == other.authority
    assert (one.common_name(), other.common_name()) == ("station", "station:second")
    names = parse_certificate(other.certificate, "certificate").extensions
    assert "10.0.0.2" in str(names)
    assert not (second.path / "authority.key").exists()


def test_incomplete_folder_is_not_joined_and_the_remedy_is_reported(
    first: PkiFolder, tmp_path: Path
) -> None:
    file = tmp_path / "second.station.toml"
    first.enroll_station("second", ["10.0.0.2"], SECOND).write(file)
    folder = PkiFolder(tmp_path / "second")
    folder.path.mkdir(parents=True)
    (folder.path / "station.key").write_text("what a power cut left")
    with pytest.raises(ConfigError, match=r"registry\.json is missing.*move its folder away"):
        folder.join(read_station_enrolment(file))


def test_both_stations_accept_the_same_units_and_each_other(
    first: PkiFolder, second: PkiFolder
) -> None:
    first.enroll("FF-01")
    second.take_registry(first.registry())
    for folder in (first, second):
        subjects = {one["id"] for one in access_control(folder.registry())["subjects"]}
        assert subjects == {"station", "station:second", "FF-01"}


def test_units_enrolled_from_now_on_know_both(first: PkiFolder, second: PkiFolder) -> None:
    del second
    assert first.enroll("FF-01").connect == (FIRST, SECOND)


def test_units_know_the_second_station_though_the_first_has_moved(
    first: PkiFolder, second: PkiFolder
) -> None:
    del second
    moved = "tls/10.0.0.9:7447"
    for _ in range(2):
        first.renew_station(hosts=["10.0.0.9"], connect=[moved])
        assert first.registry().connect == (moved, SECOND)
    first.renew_station(hosts=["10.0.0.2"], connect=[SECOND])  # onto the other one's machine
    assert first.registry().connect == (SECOND,)


@pytest.mark.parametrize("asks_first", [True, False])
def test_former_address_of_the_first_does_not_come_back_from_the_second(
    first: PkiFolder, second: PkiFolder, asks_first: bool
) -> None:
    moved = "tls/10.0.0.9:7447"
    first.renew_station(hosts=["10.0.0.9"], connect=[moved])
    for taking in (asks_first, not asks_first):
        one, other = (first, second) if taking else (second, first)
        one.take_registry(other.registry())
    assert first.registry().connect == second.registry().connect == (moved, SECOND)


def test_addresses_stated_by_a_clock_that_was_set_back_are_the_later_ones(
    first: PkiFolder, second: PkiFolder, tmp_path: Path
) -> None:
    earlier = PkiFolder(tmp_path / "first", lambda: datetime.now(UTC) - timedelta(hours=12))
    earlier.renew_station(hosts=["10.0.0.9"], connect=["tls/10.0.0.9:7447"])
    second.take_registry(first.registry())
    assert second.registry().connect == ("tls/10.0.0.9:7447", SECOND)


def test_revocation_by_either_holds_at_both(first: PkiFolder, second: PkiFolder) -> None:
    first.enroll("FF-01")
    second.take_registry(first.registry())
    second.revoke("FF-01")
    first.take_registry(second.registry())
    assert first.registry().entries == second.registry().entries
    assert first.enroll("FF-01").identity.common_name() == "FF-01#2"


def test_revocation_by_one_holds_though_the_other_renewed_meanwhile(
    first: PkiFolder, second: PkiFolder, tmp_path: Path
) -> None:
    first.enroll("FF-01")
    second.take_registry(first.registry())
    second.revoke("FF-01")
    later = PkiFolder(tmp_path / "first", lambda: datetime.now(UTC) + timedelta(hours=1))
    later.renew("FF-01")
    revoked, renewed = second.registry(), first.registry()
    for merged in (revoked.merged(renewed), renewed.merged(revoked)):
        (entry,) = (one for one in merged.entries if one.common_name == "FF-01")
        assert entry.revoked is not None
        assert entry.valid_from > revoked.entries[-1].valid_from
        assert "FF-01" not in {one["id"] for one in access_control(merged)["subjects"]}


def test_newer_certificate_holds_in_any_order_of_reception(
    first: PkiFolder, second: PkiFolder, tmp_path: Path
) -> None:
    first.enroll("FF-01")
    second.take_registry(first.registry())
    old = second.registry()
    later = PkiFolder(tmp_path / "first", lambda: datetime.now(UTC) + timedelta(hours=1))
    later.renew("FF-01")
    for registry in (first.registry().merged(old), old.merged(first.registry())):
        assert set(registry.entries) == set(first.registry().entries)
        assert [len(entry.earlier) for entry in registry.entries if entry.name == "FF-01"] == [1]


def test_station_is_enrolled_again_for_a_new_certificate(
    first: PkiFolder, second: PkiFolder
) -> None:
    second.join(first.enroll_station("second", ["10.0.0.9"], SECOND))
    assert second.station_identity().common_name() == "station:second"
    assert len(second.registry().entries) == 2


def test_each_station_reports_whose_certificate_ends_and_where_it_is_renewed(
    first: PkiFolder, second: PkiFolder
) -> None:
    end = datetime.now(UTC) + timedelta(days=400)

    def reported(folder: PkiFolder) -> list[str]:
        here = folder.own_common_name()
        ending = about_to_expire(folder.registry(), end, timedelta(), here)
        return [re.sub(r"expired on [\d-]+", "expired", one) for one in ending]

    anew = "muster pki enroll-station second --host ADDRESS at the first station, and "
    joined = f"{anew}muster pki join at second"
    assert reported(first) == [
        "The certificate of this station expired: muster pki renew-station",
        f"The certificate of station second expired: {joined}",
    ]
    assert reported(second) == [
        "The certificate of the first station expired: muster pki renew-station there",
        f"The certificate of this station expired: {joined}",
    ]


def test_further_station_with_an_ended_certificate_reports_where_to_renew_it(
    second: PkiFolder, tmp_path: Path
) -> None:
    later = PkiFolder(tmp_path / "second", lambda: datetime.now(UTC) + timedelta(days=400))
    assert later.path == second.path
    with pytest.raises(ConfigError, match=r"expired on .*enroll-station` at the first station"):
        later.require_valid_station()


def test_file_for_another_machine_changes_nothing(first: PkiFolder, second: PkiFolder) -> None:
    third = first.enroll_station("third", ["10.0.0.3"], "tls/10.0.0.3:7447")
    for folder in (first, second):
        before = folder.station_identity(), folder.registry()
        with pytest.raises(ConfigError, match=r"another station.*for third: take it to that"):
            folder.join(third)
        assert (folder.station_identity(), folder.registry()) == before


def test_damaged_certificate_is_replaced_by_joining_again(
    first: PkiFolder, second: PkiFolder
) -> None:
    (second.path / "station.pem").write_text("no certificate")
    second.join(first.enroll_station("second", ["10.0.0.2"], SECOND))
    assert second.station_identity().common_name() == "station:second"


def test_revoked_station_joins_again_under_its_name(first: PkiFolder, second: PkiFolder) -> None:
    first.revoke("second", Holder.STATION)
    second.take_registry(first.registry())
    second.join(first.enroll_station("second", ["10.0.0.2"], SECOND))
    assert second.station_identity().common_name() == "station:second#2"


def test_full_disk_leaves_no_partial_second_station(
    first: PkiFolder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = first.enroll_station("second", ["10.0.0.2"], SECOND)
    folder = PkiFolder(tmp_path / "second")

    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as disk:
        disk.setattr("base_station.storage.private_files.os.fsync", full)
        with pytest.raises(StoreError, match="No space left"):
            folder.join(file)
    folder.join(file)
    assert folder.station_identity().common_name() == "station:second"


def test_folder_of_another_authority_is_left_alone(first: PkiFolder, tmp_path: Path) -> None:
    other = PkiFolder(tmp_path / "other")
    other.create("Other", [], [FIRST])
    with pytest.raises(ConfigError, match="another authority"):
        other.join(first.enroll_station("second", [], SECOND))


@pytest.mark.parametrize("share", [0.0, 0.5, 0.99])
def test_truncated_file_is_refused(first: PkiFolder, tmp_path: Path, share: float) -> None:
    text = first.enroll_station("second", [], SECOND).to_toml()
    file = tmp_path / "short.toml"
    file.write_text(text[: round(share * len(text))])
    with pytest.raises(ConfigError, match="copy the whole file again"):
        read_station_enrolment(file)
