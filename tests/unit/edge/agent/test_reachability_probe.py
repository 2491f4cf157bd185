"""Probe of stations: a station that accepts connections again is detected at once."""

from __future__ import annotations

import socket
import threading
import time

import pytest

from edge.agent.reachability_probe import ReachabilityProbe
from tests.rig.station_process import free_port


@pytest.fixture
def port() -> int:
    return free_port()


def listen(port: int) -> socket.socket:
    listening = socket.create_server(("127.0.0.1", port))
    listening.listen()
    return listening


@pytest.mark.parametrize("proto", ["tcp", "tls"])
def test_listening_station_is_found(port: int, proto: str) -> None:
    with listen(port):
        assert ReachabilityProbe([f"{proto}/127.0.0.1:{port}"]).wait(5.0)


def test_machine_without_a_station_is_not_found(port: int) -> None:
    probe = ReachabilityProbe([f"tcp/127.0.0.1:{port}"])
    assert not probe.wait(0.5)
    probe.close()


def test_unknown_name_is_not_found() -> None:
    assert not ReachabilityProbe(["tls/station.invalid:7447"]).wait(0.2)


def test_one_of_two_stations_suffices(port: int) -> None:
    with listen(port):
        assert ReachabilityProbe([f"tcp/127.0.0.1:{free_port()}", f"tcp/127.0.0.1:{port}"]).wait(
            5.0
        )


def test_an_ipv6_station_is_found() -> None:
    try:
        listening = socket.create_server(("::1", 0), family=socket.AF_INET6)
    except OSError:
        pytest.skip("this machine has no IPv6")
    with listening:
        assert ReachabilityProbe([f"tcp/[::1]:{listening.getsockname()[1]}"]).wait(5.0)


def test_station_is_found_by_any_address_of_its_name(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """``localhost`` is mostly ::1 first, and a station listens on 0.0.0.0."""

    def looked_up(_host: str, port: int, **_: object) -> list[tuple[object, ...]]:
        tcp = socket.SOCK_STREAM, socket.IPPROTO_TCP, ""
        return [
            (socket.AF_INET6, *tcp, ("::1", port, 0, 0)),
            (socket.AF_INET, *tcp, ("127.0.0.1", port)),
        ]

    monkeypatch.setattr(socket, "getaddrinfo", looked_up)
    with listen(port):
        assert ReachabilityProbe([f"tcp/localhost:{port}"]).wait(5.0)


def test_station_that_comes_during_the_wait_is_noticed(port: int) -> None:
    probe = ReachabilityProbe([f"tcp/127.0.0.1:{port}"])
    stations: list[socket.socket] = []
    later = threading.Timer(0.5, lambda: stations.append(listen(port)))
    later.start()
    began_s = time.monotonic()
    assert probe.wait(30.0)
    assert time.monotonic() - began_s < 15.0
    later.join()
    stations[0].close()


def test_many_probes_hold_only_a_few_connections() -> None:
    """With dropped packets attempts accumulate, and the oldest are ended."""
    probe = ReachabilityProbe(["tcp/192.0.2.1:7447"])  # an address without a host
    for _ in range(40):
        probe._begin_attempts()
    assert len(probe._attempts) <= 8
    probe.close()
    assert probe._attempts == []
