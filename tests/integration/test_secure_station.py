"""``muster base serve`` with its own authority: units enrolled and revoked while it runs."""

from __future__ import annotations

import ssl
from collections.abc import Callable, Iterator
from contextlib import closing
from datetime import timedelta
from pathlib import Path

import httpx
import pytest

from base_station.security.pki.folder import PkiFolder
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import POSITION, Qos
from shared.codec import encode
from shared.enrolment import Enrolment
from shared.messages import Position
from tests.rig.station_command import Browser, Command
from tests.rig.station_process import free_port
from tests.rig.waiting import PATIENCE_S, until

MakePosition = Callable[..., Position]


@pytest.fixture
def data(tmp_path: Path) -> Path:
    return tmp_path / "station"


@pytest.fixture
def pki(data: Path) -> PkiFolder:
    folder = PkiFolder(data)
    folder.create("Test", hosts=[], connect=[f"tls/127.0.0.1:{free_port()}"])
    return folder


@pytest.fixture
def serve(tmp_path: Path, data: Path) -> Iterator[Callable[..., Command]]:
    started: list[Command] = []

    def start(*flags: str, http: str = "127.0.0.1:0") -> Command:
        output = tmp_path / f"output-{len(started)}.txt"
        started.append(Command(output, "serve", "--data", str(data), "--http", http, *flags))
        return started[-1]

    yield start
    for command in started:
        command.kill()


def join(enrolment: Enrolment) -> ZenohBus:
    return ZenohBus(UnitEndpoint(enrolment.connect, enrolment.identity))


def test_a_unit_is_enrolled_and_revoked_while_the_station_runs(
    serve: Callable[..., Command], pki: PkiFolder, data: Path, make_position: MakePosition
) -> None:
    (listen,) = pki.registry().connect
    station = serve("--listen", listen)
    key = POSITION.key("FF-01")
    with Browser(station.wait_ready(), data) as browser:
        assert not browser.call("GET", "/health")["insecure"]
        with closing(join(pki.enroll("FF-01"))) as unit:
            until(lambda: unit.has_subscriber(key), "the unit is let in")
            unit.publish(key, encode(make_position()), Qos.LIVE)
            until(lambda: browser.call("GET", "/health")["messages"] == 1, "it is heard")
            pki.revoke("FF-01")
            until(lambda: not unit.has_subscriber(key), "the unit is shut out")
            until(lambda: not unit.is_linked(), "its link ends")
            unit.publish(key, encode(make_position()), Qos.LIVE)
        again = pki.enroll("FF-01", valid=timedelta(days=3))
        with closing(join(again)) as unit:
            until(lambda: unit.has_subscriber(key), "its successor is let in")
            unit.publish(key, encode(make_position()), Qos.LIVE)
            until(lambda: browser.call("GET", "/health")["messages"] >= 2, "it is heard")
        assert browser.call("GET", "/health")["messages"] == 2  # not what was said in between

        def revoked() -> list[str]:
            audit = browser.call("GET", "/audit")
            return [one["detail"] for one in audit if one["action"] == "RevokedCertificate"]

        until(lambda: [one.partition(", at")[0] for one in revoked()] == ["unit FF-01 as FF-01"])
    assert station.stop() == 0


def test_expiring_certificates_are_among_the_problems(
    serve: Callable[..., Command], pki: PkiFolder, data: Path
) -> None:
    pki.enroll("FF-01", valid=timedelta(days=3))
    (listen,) = pki.registry().connect
    station = serve("--listen", listen)
    with Browser(station.wait_ready(), data) as browser:
        until(
            lambda: any(
                problem == "The certificate of unit FF-01 expires in 2 days: muster pki renew FF-01"
                for problem in browser.call("GET", "/health")["problems"]
            ),
            "the expiry is shown",
        )


def test_station_loads_its_renewed_certificate_before_the_old_one_expires(
    serve: Callable[..., Command], pki: PkiFolder, data: Path, make_position: MakePosition
) -> None:
    """Or it would hear nobody from then on, with everything in order by its folder."""
    (listen,) = pki.registry().connect
    station = serve("--listen", listen, http=f"127.0.0.1:{free_port()}")
    address, key = station.wait_ready(), POSITION.key("FF-01")
    with closing(join(pki.enroll("FF-01"))) as unit, Browser(address, data) as browser:
        until(lambda: unit.has_subscriber(key), "the unit is let in")
        pki.renew_station()
        until(lambda: station.output().count("ready ") == 2, "the station begins again")

        def received() -> bool:
            unit.publish(key, encode(make_position()), Qos.LIVE)
            return bool(browser.call("GET", "/health")["messages"])

        until(received, "the unit is heard again")
    assert station.output().count("taken up") == 1
    assert station.stop() == 0


def test_station_without_an_authority_names_the_remedy(
    serve: Callable[..., Command], data: Path
) -> None:
    station = serve()
    assert station.wait() == 2
    assert not data.exists()
    assert "make one with `muster pki init`" in station.output()
    assert "Traceback" not in station.output()


def test_the_console_can_be_served_with_the_stations_certificate(
    serve: Callable[..., Command], pki: PkiFolder, tmp_path: Path
) -> None:
    (listen,) = pki.registry().connect
    settings = tmp_path / "station.toml"
    settings.write_text(
        f'[http]\ncertificate = "{pki.path}/station.pem"\nprivate_key = "{pki.path}/station.key"\n'
    )
    address = serve("--listen", listen, "--config", str(settings)).wait_ready()
    assert address.startswith("https://")
    trusting = ssl.create_default_context(cafile=str(pki.path / "authority.pem"))
    health = f"{address}/api/v1/health"
    assert (
        httpx.get(health, verify=trusting, timeout=PATIENCE_S).status_code == 401
    )  # reached, and not logged in
    with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
        httpx.get(health, timeout=PATIENCE_S)


def test_station_with_an_expired_certificate_is_refused_at_the_start(
    serve: Callable[..., Command], data: Path
) -> None:
    address = f"tls/127.0.0.1:{free_port()}"
    PkiFolder(data).create("Test", [], [address], valid=timedelta(seconds=-1))
    station = serve("--listen", address)
    assert station.wait() == 2
    assert "renew-station" in station.output()
