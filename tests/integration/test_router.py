"""The router's process: rules follow the registry, it is kept running, it dies with its parent."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import msgspec
import psutil
import pytest

from base_station.security.pki.folder import PkiFolder
from base_station.security.router.process import RouterProcess, RouterSettings, start_loading
from base_station.security.router.router import Router, station_endpoint
from shared.bus_zenoh import ClientEndpoint, UnitEndpoint, ZenohBus
from shared.channels import POSITION, Qos, alive_key
from shared.enrolment import Enrolment
from shared.errors import BusError, ConfigError, MusterError
from tests.rig.station_process import free_port
from tests.rig.waiting import PATIENCE_S, until

KEY = POSITION.key("anna")


@pytest.fixture
def address() -> str:
    return f"127.0.0.1:{free_port()}"


@pytest.fixture
def listen(address: str) -> tuple[str, ...]:
    return (f"tls/{address}",)


@pytest.fixture
def pki(tmp_path: Path, listen: tuple[str, ...]) -> PkiFolder:
    folder = PkiFolder(tmp_path)
    folder.create("Test", hosts=[], connect=listen)
    return folder


@pytest.fixture
def process(tmp_path: Path, pki: PkiFolder, listen: tuple[str, ...]) -> Iterator[RouterProcess]:
    with closing(RouterProcess(tmp_path, listen).wait_open()) as running:
        yield running


def station(pki: PkiFolder, listen: tuple[str, ...]) -> ZenohBus:
    return ZenohBus(station_endpoint(pki.path.parent, listen))


def unit(enrolment: Enrolment) -> ZenohBus:
    return ZenohBus(UnitEndpoint(enrolment.connect, enrolment.identity))


def test_enrolling_and_revoking_take_effect_while_it_runs(
    process: RouterProcess, pki: PkiFolder, listen: tuple[str, ...]
) -> None:
    received: list[str] = []
    with closing(station(pki, listen)) as base:
        base.subscribe("muster/v1/**", lambda key, _: received.append(key))
        with closing(unit(pki.enroll("anna"))) as anna:
            until(lambda: anna.has_subscriber(KEY), "the right to speak")
            anna.publish(KEY, b"", Qos.LIVE)
            until(lambda: received == [KEY], "the message")
            pki.revoke("anna")
            until(lambda: not anna.is_linked(), "the end of the link")
            refused = process.refused.total
            until(lambda: process.refused.total > refused + 1, "further tries, refused")
            assert not anna.is_linked()
            anna.publish(KEY, b"", Qos.LIVE)
            time.sleep(0.5)
    assert received == [KEY]


def test_revocation_keeps_the_links_of_others(
    process: RouterProcess, pki: PkiFolder, listen: tuple[str, ...]
) -> None:
    enrolments = [pki.enroll(name) for name in ("anna", "ben")]
    tokens: list[tuple[str, bool]] = []
    with closing(station(pki, listen)) as base, closing(unit(enrolments[0])) as anna:
        base.watch_alive(alive_key("*"), lambda key, there: tokens.append((key, there)))
        with closing(unit(enrolments[1])) as ben:
            held = [anna.declare_alive(alive_key("anna")), ben.declare_alive(alive_key("ben"))]
            until(lambda: {key for key, _ in tokens} == {alive_key("anna"), alive_key("ben")})
            tokens.clear()
            pki.revoke("ben")
            until(lambda: tokens, "the end of the revoked one's link")
            refused = process.refused.total
            until(lambda: process.refused.total > refused + 1, "further tries, refused")
            assert tokens == [(alive_key("ben"), False)]
            assert len(held) == 2


def test_killed_router_is_restarted(
    process: RouterProcess, pki: PkiFolder, listen: tuple[str, ...]
) -> None:
    with closing(station(pki, listen)) as base, closing(unit(pki.enroll("anna"))) as anna:
        base.subscribe("muster/v1/**", lambda *_: None)
        until(lambda: anna.has_subscriber(KEY), "the right to speak")
        first = process.pid
        os.kill(first, signal.SIGKILL)
        until(lambda: process.pid != first and anna.has_subscriber(KEY), "everything again")


def test_closed_router_process_ends(process: RouterProcess) -> None:
    assert psutil.pid_exists(process.pid)
    process.close()
    assert not psutil.pid_exists(process.pid)


def test_router_ends_when_its_parent_is_killed(
    tmp_path: Path, pki: PkiFolder, listen: tuple[str, ...]
) -> None:
    script = (
        "import sys, time; from pathlib import Path\n"
        "from base_station.security.router.process import RouterProcess\n"
        "print(RouterProcess(Path(sys.argv[1]), (sys.argv[2],)).wait_open().pid, flush=True)\n"
        "time.sleep(600)\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script, str(tmp_path), *listen], stdout=subprocess.PIPE, text=True
    ) as parent:
        assert parent.stdout is not None
        router_pid = int(parent.stdout.readline())
        assert psutil.pid_exists(router_pid)
        parent.kill()
        until(lambda: not psutil.pid_exists(router_pid), "the router's end")


@pytest.mark.parametrize("endpoint", ["tcp/127.0.0.1:{port}", "tcp/no such host:{port}"])
def test_router_ends_silently_when_its_parent_was_killed_before_it_opened(
    tmp_path: Path, endpoint: str
) -> None:
    reported = tmp_path / "said.txt"
    reading, writing = os.pipe()
    settings = RouterSettings(str(tmp_path), (endpoint.format(port=free_port()),), (), ())
    with reported.open("wb") as errors:
        router = subprocess.Popen(
            [sys.executable, "-m", "base_station.security.router"],
            stdin=subprocess.PIPE,
            stdout=writing,
            stderr=errors,
        )
    assert router.stdin is not None
    router.stdin.write(msgspec.json.encode(settings) + b"\n")
    router.stdin.close()
    os.close(reading)
    os.close(writing)
    router.wait(PATIENCE_S)
    assert "Traceback" not in reported.read_text()
    assert "Broken" not in reported.read_text()


def test_router_without_settings_ends_normally() -> None:
    with start_loading() as loading:
        assert loading.stdin is not None
        loading.stdin.close()
        assert loading.wait(PATIENCE_S) == 0


def test_preloaded_router_is_used_first(
    tmp_path: Path, pki: PkiFolder, listen: tuple[str, ...]
) -> None:
    loading = start_loading()
    with closing(RouterProcess(tmp_path, listen, loading=loading).wait_open()) as running:
        assert running.pid == loading.pid


def test_router_that_ended_during_loading_is_reported(
    tmp_path: Path, pki: PkiFolder, listen: tuple[str, ...]
) -> None:
    loading = start_loading()
    loading.kill()
    loading.wait(PATIENCE_S)
    with pytest.raises(BusError, match="ended before it was open"):
        RouterProcess(tmp_path, listen, loading=loading).wait_open()


def test_reason_for_not_opening_is_reported(tmp_path: Path, listen: tuple[str, ...]) -> None:
    with pytest.raises(BusError, match="no certificate authority; make one with `muster pki init`"):
        RouterProcess(tmp_path, listen).wait_open()


def test_port_in_use_is_reported_without_a_crash(
    process: RouterProcess,
    tmp_path: Path,
    listen: tuple[str, ...],
    capfd: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(BusError, match="another program uses this port"):
        RouterProcess(tmp_path, listen).wait_open()
    assert "Fatal" not in capfd.readouterr().err


def test_a_damaged_registry_leaves_the_rules_as_they_were(
    tmp_path: Path, pki: PkiFolder, listen: tuple[str, ...], caplog: pytest.LogCaptureFixture
) -> None:
    anna = pki.enroll("anna")
    good = pki.registry_path.read_bytes()
    with closing(Router(tmp_path, listen)) as router, closing(station(pki, listen)) as base:
        base.subscribe("muster/v1/**", lambda *_: None)
        pki.registry_path.write_bytes(good[:100])
        router.refresh()
        router.refresh()
        assert [record.levelname for record in caplog.records] == ["ERROR"]
        assert "access rules stay as they were" in caplog.text
        with closing(unit(anna)) as bus:
            until(lambda: bus.has_subscriber(KEY), "the right to speak")
        pki.registry_path.write_bytes(good)
        router.refresh()
        assert len(caplog.records) == 1  # nothing changed: not opened again


def test_a_renewed_station_certificate_is_taken_up(
    tmp_path: Path, pki: PkiFolder, listen: tuple[str, ...]
) -> None:
    anna = pki.enroll("anna")
    with (
        closing(Router(tmp_path, listen)) as router,
        closing(station(pki, listen)) as base,
        closing(unit(anna)) as bus,
    ):
        base.subscribe("muster/v1/**", lambda *_: None)
        until(lambda: bus.has_subscriber(KEY), "the right to speak")
        pki.renew_station()
        router.refresh()
        until(lambda: bus.has_subscriber(KEY), "the right to speak, to the renewed station")


def test_plain_tcp_works_when_configured(tmp_path: Path, address: str) -> None:
    plain = (f"tcp/{address}",)
    with (
        closing(RouterProcess(tmp_path, plain).wait_open()),
        closing(ZenohBus(ClientEndpoint(plain))) as base,
        closing(ZenohBus(UnitEndpoint(plain))) as bus,
    ):
        base.subscribe("muster/v1/**", lambda *_: None)
        until(lambda: bus.has_subscriber(KEY), "the station's interest")


def test_plain_and_secure_endpoints_together_are_refused(
    tmp_path: Path, listen: tuple[str, ...]
) -> None:
    with pytest.raises(ConfigError, match="either secure or not"):
        Router(tmp_path, (*listen, "tcp/127.0.0.1:1"))


def test_the_station_finds_its_router_on_the_loopback(tmp_path: Path) -> None:
    for listen, found in (
        (("tcp/0.0.0.0:7447",), "tcp/127.0.0.1:7447"),
        (("tcp/[::]:7447",), "tcp/[::1]:7447"),
        (("tcp/192.0.2.7:7447", "tcp/0.0.0.0:1"), "tcp/192.0.2.7:7447"),
    ):
        assert station_endpoint(tmp_path, listen).connect == (found,)


def test_station_certificate_without_its_address_is_reported_at_once(tmp_path: Path) -> None:
    pki = PkiFolder(tmp_path)
    pki.create("Test", hosts=["192.0.2.7", "Station.local", "fd00::7"], connect=[])
    for host in ("0.0.0.0", "[::]", "192.0.2.7", "station.LOCAL", "[fd00:0::7]", "localhost"):
        station_endpoint(tmp_path, (f"tls/{host}:7447",))
    for host in ("192.0.2.8", "other.local", "m\u00fcller.local", "[fd00::8]"):
        with pytest.raises(ConfigError, match=r"does not stand for .*renew-station --host"):
            station_endpoint(tmp_path, (f"tls/{host}:7447",))


@pytest.mark.parametrize("option", ["iface=no-such-one", "rubbish=1", "iface=lo;rubbish=1"])
def test_unsupported_endpoint_option_is_reported(
    tmp_path: Path, pki: PkiFolder, listen: tuple[str, ...], option: str
) -> None:
    with pytest.raises(MusterError, match=r"cannot listen on|only #iface=INTERFACE"):
        Router(tmp_path, (f"{listen[0]}#{option}",))


def test_router_listens_on_the_configured_interface_only(
    tmp_path: Path, pki: PkiFolder, listen: tuple[str, ...]
) -> None:
    anna = pki.enroll("anna")
    with (
        closing(Router(tmp_path, (f"{listen[0]}#iface=lo",))),
        closing(station(pki, listen)) as base,
    ):
        base.subscribe("muster/v1/**", lambda *_: None)
        with closing(unit(anna)) as bus:
            until(lambda: bus.has_subscriber(KEY), "the right to speak")
