"""The routers of two stations: linked, and linked again where Zenoh has given up."""

from __future__ import annotations

import socket
from contextlib import closing
from pathlib import Path

import pytest

from base_station.security.router.peer_router_probe import accepts_connections
from base_station.security.router.router import Router
from tests.rig.station_process import free_port
from tests.rig.waiting import until

LOOKS = 9  # more than a router waits before it opens again


def endpoint() -> str:
    return f"tcp/127.0.0.1:{free_port()}"


def until_linked(*routers: Router) -> None:
    """They look meanwhile, as seldom as their processes do: a link takes a moment to come about,
    and one that came about half is opened anew.
    """

    def linked() -> bool:
        for router in routers:
            router.refresh()
        return all(router._peer_probe.responds() for router in routers)

    until(linked, "they are linked", poll_interval_s=1.0)


def test_linked_routers_are_not_reopened(tmp_path: Path) -> None:
    one, other = endpoint(), endpoint()
    with (
        closing(Router(tmp_path, (one,), (other,))) as first,
        closing(Router(tmp_path, (other,), (one,))) as second,
    ):
        until_linked(first, second)
        before = first._bus, second._bus
        for _ in range(LOOKS):
            first.refresh()
            second.refresh()
        assert (first._bus, second._bus) == before


def test_open_endpoint_of_the_other_router_is_detected() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        end = f"tcp/127.0.0.1:{listening.getsockname()[1]}"
        assert accepts_connections((end,))
        assert accepts_connections((endpoint(), f"{end}#iface=lo"))
    assert not accepts_connections((f"{end}#iface=lo",))


def test_router_waits_for_an_absent_router(tmp_path: Path) -> None:
    with closing(Router(tmp_path, (endpoint(),), (endpoint(),))) as router:
        before = router._bus
        for _ in range(LOOKS):
            router.refresh()
        assert router._bus is before


def test_router_gives_a_returned_router_time_to_link(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However long it was away: opened again just then, all its units would be away too."""
    other = endpoint()
    monkeypatch.setattr("base_station.security.router.router._random_check_limit", lambda: 3)
    with closing(Router(tmp_path, (endpoint(),), (other,))) as router:
        for _ in range(8):  # the next look would be the third in a row
            router.refresh()
        before = router._bus
        monkeypatch.setattr(before, "query", lambda *_: iter(()))  # the link takes its time
        with closing(Router(tmp_path, (other,))):
            router.refresh()
            router.refresh()
            assert router._bus is before


def test_router_beside_a_hanging_router_stays_open(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:  # takes links and never answers
        other = f"tcp/127.0.0.1:{listening.getsockname()[1]}"
        with closing(Router(tmp_path, (endpoint(),), (other,))) as router:
            before = router._bus
            for _ in range(LOOKS):
                router.refresh()
            assert router._bus is before


def test_router_reopens_without_link_to_an_answering_router(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = endpoint()
    monkeypatch.setattr("base_station.security.router.router._random_check_limit", lambda: 3)
    with (
        closing(Router(tmp_path, (other,))),
        closing(Router(tmp_path, (endpoint(),), (other,))) as router,
    ):
        before = router._bus
        monkeypatch.setattr(before, "query", lambda *_: iter(()))  # as if Zenoh had given up
        for _ in range(3):
            router.refresh()
        assert router._bus is not before
        until_linked(router)
