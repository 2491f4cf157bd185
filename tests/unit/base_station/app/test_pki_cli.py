"""``muster pki``: from an authority to an enrolment, and refusals that leave nothing behind."""

from __future__ import annotations

import socket
import stat
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from base_station.app.pki_cli import app
from base_station.security.pki.folder import PkiFolder
from shared.enrolment import Holder, parse_enrolment, read_enrolment
from shared.errors import ConfigError, MusterError
from tests.rig.full_disk import files_of_at_most


def run(*arguments: str | Path) -> str:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output
    return result.output


@pytest.fixture
def data(tmp_path: Path) -> Path:
    folder = tmp_path / "data"
    run("init", "--data", folder, "--host", "station.local", "--host", "192.0.2.7")
    return folder


def test_init_prints_the_address_for_units(tmp_path: Path) -> None:
    reported = run("init", "--data", tmp_path, "--host", "fd00::7", "--port", "7000")
    assert "tls/[fd00::7]:7000" in reported
    assert PkiFolder(tmp_path).registry().connect == ("tls/[fd00::7]:7000",)


def test_init_without_a_host_takes_the_addresses_of_the_machine(tmp_path: Path) -> None:
    run("init", "--data", tmp_path)
    registry = PkiFolder(tmp_path).registry()
    assert {"localhost", "127.0.0.1", "::1"} <= set(registry.hosts)
    assert len(registry.connect) == 1


def test_units_get_an_address_of_the_network_and_ipv4_where_possible(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    addresses = ["fd00::7", "127.0.0.1", "fe80::1%eth0", "169.254.1.1", "192.0.2.7", "10.0.0.1"]
    family = {True: socket.AF_INET6, False: socket.AF_INET}
    cards = {one: [SimpleNamespace(family=family[":" in one], address=one)] for one in addresses}
    monkeypatch.setattr("psutil.net_if_addrs", lambda: cards)
    monkeypatch.setattr("socket.gethostname", lambda: "station")
    run("init", "--data", tmp_path)
    registry = PkiFolder(tmp_path).registry()
    assert registry.hosts[:4] == ("10.0.0.1", "192.0.2.7", "fd00::7", "station")
    assert not {"fe80::1%eth0", "169.254.1.1"} & set(registry.hosts)
    assert registry.connect == ("tls/10.0.0.1:7447",)


@pytest.mark.slow
@pytest.mark.parametrize(
    "host",
    ["192.0.2.7:7447", "tls/station", "a b", "", "192.0.2.256", "192.0.2", "0.0.0.0", "::"],
)
def test_init_refuses_text_that_is_no_host(tmp_path: Path, host: str) -> None:
    with pytest.raises(ConfigError, match="is no host"):
        run("init", "--data", tmp_path, "--host", host)
    assert not (tmp_path / "pki").exists()


def test_enroll_writes_one_file(data: Path, tmp_path: Path) -> None:
    out = tmp_path / "carried"
    reported = run("enroll", "FF-01", "--data", data, "--out", out)
    assert "muster edge run --enrolment carried" in reported
    enrolment = read_enrolment(out)
    assert (enrolment.holder, enrolment.name) == (Holder.UNIT, "FF-01")
    assert enrolment.connect == ("tls/station.local:7447",)


def test_enroll_names_other_ends_of_the_bus_if_given(data: Path, tmp_path: Path) -> None:
    ends = ("tls/192.0.2.9:7447", "tls/[fd00::7]:7000", "tls/station.local:1")
    flags = [flag for end in ends for flag in ("--connect", end)]
    run("enroll", "FF-01", "--data", data, "--out", tmp_path / "1", *flags)
    assert read_enrolment(tmp_path / "1").connect == ends


@pytest.mark.slow
@pytest.mark.parametrize(
    "end", ["192.0.2.9:7447", "tls/192.0.2.9", "tls/192.0.2.9:0", "tls/192.0.2.9:65536", "tls/:1",
            "tcp/192.0.2.9:7447", 'tls/a"b:7447', "tls/192.0.2.900:7447"],
)  # fmt: skip
def test_unreachable_end_is_reported_before_the_enrolment(
    data: Path, tmp_path: Path, end: str
) -> None:
    with pytest.raises(ConfigError, match=r"is no (end of a bus|host)"):
        run("enroll", "FF-01", "--data", data, "--out", tmp_path / "1", "--connect", end)
    assert PkiFolder(data).registry().current(Holder.UNIT, "FF-01") is None


def test_enroll_names_the_file_after_the_unit(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    run("enroll", "FF-01", "--data", data)
    assert read_enrolment(tmp_path / "FF-01.enrolment.toml").name == "FF-01"


def test_tracking_agent_is_enrolled_beside_its_unit_and_revoked_with_it(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    run("enroll", "FF-01", "--data", data)
    reported = run("enroll", "FF-01", "--tracker", "--data", data, "--days", "2")
    file = "FF-01@tracker.enrolment.toml"
    assert f"muster edge run --enrolment {file} --source bus:FF-01" in reported
    enrolment = read_enrolment(tmp_path / file)
    assert (enrolment.holder, enrolment.name) == (Holder.TRACKER, "FF-01")
    assert "muster pki renew --tracker FF-01" in run("show", "--data", data)
    run("revoke", "FF-01", "--tracker", "--data", data)
    registry = PkiFolder(data).registry()
    assert registry.current(Holder.TRACKER, "FF-01") is None
    assert registry.current(Holder.UNIT, "FF-01") is not None


def test_name_like_that_of_a_tracking_agent_is_refused(data: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be used"):
        run("enroll", "FF-01@tracker", "--data", data)


def test_enroll_shows_a_code_and_writes_no_file(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    reported = run("enroll", "FF-01", "--data", data, "--qr", "--png", "code.png")
    assert "█" in reported
    assert {path.name for path in tmp_path.iterdir()} == {"data", "code.png"}
    assert stat.S_IMODE((tmp_path / "code.png").stat().st_mode) == 0o600  # it holds the key


def test_code_without_room_leaves_nothing(data: Path, tmp_path: Path) -> None:
    """It holds a private key, and half of it is no enrolment."""
    code = tmp_path / "code.png"
    with (
        files_of_at_most(2000),  # room for the enrolled names
        pytest.raises(ConfigError, match=r"cannot be written .*`muster pki renew FF-01`"),
    ):
        run("enroll", "FF-01", "--data", data, "--png", code)
    assert not code.exists()
    run("renew", "FF-01", "--data", data, "--png", code)
    assert code.stat().st_size > 2000


def test_existing_file_is_reported_before_the_enrolment(data: Path, tmp_path: Path) -> None:
    out = tmp_path / "carried"
    out.write_text("precious")
    for place, problem in ((out, "is there already"), (tmp_path / "no" / "x", "cannot write")):
        with pytest.raises(MusterError, match=problem):
            run("enroll", "FF-01", "--data", data, "--out", place)
    assert PkiFolder(data).registry().current(Holder.UNIT, "FF-01") is None
    assert out.read_text() == "precious"


def test_renew_and_revoke(data: Path, tmp_path: Path) -> None:
    run("enroll", "FF-01", "--data", data, "--out", tmp_path / "1")
    run("renew", "FF-01", "--data", data, "--out", tmp_path / "2", "--days", "3")
    first, second = (parse_enrolment((tmp_path / name).read_text()) for name in "12")
    assert first.identity.certificate != second.identity.certificate
    assert "expires in 2 days: muster pki renew FF-01" in run("show", "--data", data)
    assert "shut out" in run("revoke", "FF-01", "--data", data)
    assert "revoked" in run("show", "--data", data)


def test_list_shows_enrolled_names_complete_in_a_narrow_window(
    data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A truncated name or date is useless: a revoked unit's row is the longest."""
    monkeypatch.setenv("COLUMNS", "60")
    name = "engine-12-spare-unit"
    for number in ("1", "2"):
        run("enroll", name, "--data", data, "--out", tmp_path / number)
        if number == "1":
            run("revoke", name, "--data", data)
    shown = run("show", "--data", data)
    assert "…" not in shown
    revoked, valid = (
        one for one in PkiFolder(data).registry().entries if one.holder is Holder.UNIT
    )
    (row,) = (line for line in shown.splitlines() if revoked.serial[:8] in line)
    assert name in row
    assert f"{revoked.valid_to:%Y-%m-%d}" in row
    assert f"revoked {revoked.revoked:%Y-%m-%d}" in row
    (row,) = (line for line in shown.splitlines() if valid.serial[:8] in line)
    assert f"{valid.valid_to:%Y-%m-%d}" in row


def test_operator_is_distinguished(data: Path, tmp_path: Path) -> None:
    reported = run("enroll", "chief", "--operator", "--data", data, "--out", tmp_path / "1")
    assert "operator chief" in reported
    assert "muster edge" not in reported
    with pytest.raises(ConfigError, match="no unit chief"):
        run("revoke", "chief", "--data", data)
    run("revoke", "chief", "--operator", "--data", data)


def test_station_is_renewed_for_its_hosts_or_for_others(data: Path) -> None:
    assert "station.local" in run("renew-station", "--data", data)
    reported = run("renew-station", "--data", data, "--host", "192.0.2.9", "--port", "7000")
    assert "station.local" not in reported
    assert PkiFolder(data).registry().connect == ("tls/192.0.2.9:7000",)
    with pytest.raises(ConfigError, match="with --host where units reach it"):
        run("renew-station", "--data", data, "--port", "7001")
