"""Notifications to the service manager."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from shared.service_manager import ServiceManager


@pytest.fixture
def manager_socket(tmp_path: Path) -> Iterator[socket.socket]:
    """Whoever started this program, listening as systemd does."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listening:
        listening.bind(str(tmp_path / "notify"))
        listening.settimeout(10.0)
        yield listening


def test_service_manager_gets_ready_and_watchdog(manager_socket):
    manager = ServiceManager({"NOTIFY_SOCKET": manager_socket.getsockname()})
    manager.ready()
    manager.working()
    assert [manager_socket.recv(100) for _ in range(2)] == [b"READY=1", b"WATCHDOG=1"]


def test_an_address_without_a_file_is_understood():
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listening:
        listening.bind("")  # the system chooses a name in the abstract namespace
        listening.settimeout(10.0)
        name = listening.getsockname()[1:].decode("ascii")
        ServiceManager({"NOTIFY_SOCKET": f"@{name}"}).ready()
        assert listening.recv(100) == b"READY=1"


def test_without_one_nothing_is_stated():
    ServiceManager({}).ready()


def test_missing_service_manager_is_ignored(tmp_path):
    ServiceManager({"NOTIFY_SOCKET": str(tmp_path / "gone")}).working()


def test_unread_notification_does_not_block(manager_socket):
    manager = ServiceManager({"NOTIFY_SOCKET": manager_socket.getsockname()})
    for _ in range(10_000):
        manager.working()
    assert manager_socket.recv(100) == b"WATCHDOG=1"
