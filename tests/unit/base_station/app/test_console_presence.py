"""The console's name on its network: announced where others reach it, and obstacles reported."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from base_station.app.console_presence import ConsolePresence
from base_station.config import HttpConfig
from base_station.security.pki.folder import PkiFolder
from shared.discovery import ConsoleAnnouncement
from shared.errors import BusError, ConfigError
from tests.rig.announced import Announced

Presence = Callable[..., ConsolePresence]


@pytest.fixture
def own() -> list[str]:
    """Names and addresses of this machine."""
    return ["192.0.2.7", "box"]


@pytest.fixture
def presence(own: list[str], announced: Announced) -> Iterator[Presence]:
    with ExitStack() as stack:

        def begin(config: HttpConfig) -> ConsolePresence:
            return stack.enter_context(ConsolePresence(config, lambda: own))

        yield begin


def test_console_is_not_announced_by_default(presence: Presence, announced: Announced) -> None:
    console = presence(HttpConfig("0.0.0.0:8443"))
    console.update()
    assert announced.now == []
    assert console.problems() == ()


def test_addresses_of_the_machine_are_announced_as_they_change(
    presence: Presence, announced: Announced, own: list[str]
) -> None:
    console = presence(HttpConfig("0.0.0.0:8443", local_name="muster"))
    console.update()
    console.update()
    ((announcement, interfaces),) = announced.now
    assert announcement == ConsoleAnnouncement("muster", 8443, False, ("192.0.2.7",))
    assert (announcement.name, interfaces) == ("muster.local", ())
    own[0] = "198.51.100.1"
    console.update()
    ((announcement, _),) = announced.now
    assert announcement.addresses == ("198.51.100.1",)


def test_name_of_another_machine_is_a_problem_until_it_is_free(
    presence: Presence, announced: Announced
) -> None:
    console = presence(HttpConfig("192.0.2.7:8443", local_name="muster"))
    announced.fault = BusError("another machine on the network is muster.local already")
    console.update()
    (problem,) = console.problems()
    assert "another machine" in problem
    announced.fault = None
    console.update()
    assert announced.now[0][1] == ("192.0.2.7",)
    assert console.problems() == ()


@pytest.mark.parametrize("hosts", [["192.0.2.7"], ["192.0.2.7", "muster.local"]])
def test_certificate_without_the_name_is_a_problem(
    presence: Presence, tmp_path: Path, hosts: list[str]
) -> None:
    PkiFolder(tmp_path).create("Test", hosts, ["tls/192.0.2.7:7447"])
    (certificate,) = tmp_path.rglob("station.pem")
    config = HttpConfig("0.0.0.0:8443", certificate, certificate, local_name="muster")
    problems = presence(config).problems()
    assert len(problems) == ("muster.local" not in hosts)
    assert all("renew-station --host muster.local" in problem for problem in problems)


@pytest.mark.parametrize("name", ["muster.local", "-a", "a b", "a" * 64, "ä"])
def test_text_that_is_no_host_name_is_refused(name: str) -> None:
    with pytest.raises(ConfigError, match="cannot be used"):
        HttpConfig("0.0.0.0:8443", local_name=name)


def test_console_on_the_loopback_has_no_name_on_the_network() -> None:
    with pytest.raises(ConfigError, match="no other machine reaches"):
        HttpConfig("127.0.0.1:8080", local_name="muster")
