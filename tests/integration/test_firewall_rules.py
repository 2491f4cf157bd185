"""The shipped firewall rules: the kernel accepts them, also repeatedly."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from base_station.config import BusConfig, HttpConfig, endpoint_address, host_and_port
from tests.conftest import PROJECT_ROOT

RULES = PROJECT_ROOT / "deploy" / "nftables" / "muster.nft"
# In a network of their own: those of this machine are not touched.
ALONE = ["unshare", "--net", "--map-root-user"]


def nft(commands: str) -> str:
    """Output of the commands, run one after the other in a new network namespace."""
    if shutil.which("nft") is None:
        pytest.skip("nft is not installed")
    if subprocess.run([*ALONE, "true"], capture_output=True, check=False).returncode != 0:
        pytest.skip("network namespaces are not allowed")
    run = [*ALONE, "sh", "-ec", commands, "sh", str(RULES)]
    done = subprocess.run(run, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_rules_are_valid_and_can_be_loaded_again() -> None:
    loaded = nft('nft -c -f "$1"; nft -f "$1"; nft -f "$1"; nft list table inet muster')
    assert loaded.count("ct count over") == 2
    assert loaded.count("limit rate over") == 2


def test_the_rules_are_for_the_ports_that_a_station_has_by_default() -> None:
    (_, bus), (_, console) = (
        endpoint_address(BusConfig().listen[0]),
        host_and_port(HttpConfig().listen),
    )
    ports = [line for line in RULES.read_text().splitlines() if line.startswith("define")]
    assert f"define bus_port = {bus}" in ports
    assert any(line.startswith("define console_ports") and str(console) in line for line in ports)


def test_the_commands_of_the_page_work() -> None:
    page = (PROJECT_ROOT / "docs" / "howto" / "when-attacked.md").read_text()
    commands = [line.partition(" #")[0] for line in page.splitlines() if line.startswith("nft add")]
    assert commands
    listed = nft(f'nft -f "$1"; {"; ".join(commands)}; nft list table inet muster')
    assert "10.0.0.77 expires" in listed
