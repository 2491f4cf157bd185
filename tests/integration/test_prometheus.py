"""Prometheus reads a station's metrics, and the shipped alert rules."""

from __future__ import annotations

import json
import shutil
import subprocess
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest

from shared.bus_zenoh import UnitEndpoint
from tests.rig.simulated_units import BenchUnit
from tests.rig.station_process import StationProcess, free_port, station_process
from tests.rig.waiting import PATIENCE_S, until

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = ROOT / "deploy/prometheus"
PROMETHEUS = shutil.which("prometheus")

pytestmark = pytest.mark.skipif(
    PROMETHEUS is None or shutil.which("promtool") is None, reason="Prometheus is not installed"
)


def promtool(*arguments: str) -> None:
    checked = subprocess.run(["promtool", *arguments], capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_shipped_rules_pass_their_tests() -> None:
    promtool("test", "rules", str(ROOT / "tests/integration/muster.rules.test.yml"))


def test_shipped_configuration_is_valid() -> None:
    promtool("check", "config", "--syntax-only", str(SHIPPED / "prometheus.yml"))


@contextmanager
def prometheus(folder: Path, station_url: str, token: str) -> Iterator[str]:
    """A Prometheus that scrapes the station each second; gives its address."""
    (folder / "muster.token").write_text(token)
    shutil.copy(SHIPPED / "muster.rules.yml", folder)
    shipped = (SHIPPED / "prometheus.yml").read_text()
    for as_shipped, here in (
        ("10s", "1s"),
        ("scheme: https", "scheme: http"),
        ("/etc/prometheus/muster.token", str(folder / "muster.token")),
        ("station.example:8443", station_url.removeprefix("http://")),
    ):
        assert as_shipped in shipped
        shipped = shipped.replace(as_shipped, here)
    lines = [line for line in shipped.splitlines() if "tls_config" not in line]
    (folder / "prometheus.yml").write_text(
        "\n".join(line for line in lines if "ca_file" not in line)
    )
    address = f"127.0.0.1:{free_port()}"
    assert PROMETHEUS is not None
    with (folder / "output.txt").open("w") as output:
        running = subprocess.Popen(
            [
                PROMETHEUS,
                f"--config.file={folder}/prometheus.yml",
                f"--storage.tsdb.path={folder}/data",
                f"--web.listen-address={address}",
            ],
            stdout=output,
            stderr=output,
        )
    try:
        yield f"http://{address}"
    finally:
        running.terminate()
        running.wait(PATIENCE_S)


def query(address: str, expression: str) -> list[dict[str, Any]]:
    try:
        with urllib.request.urlopen(f"{address}/api/v1/query?query={quote(expression)}") as answer:
            result: list[dict[str, Any]] = json.load(answer)["data"]["result"]
            return result
    except OSError:  # it has not begun to listen yet
        return []


def number(address: str, expression: str) -> float | None:
    found = query(address, expression)
    return float(found[0]["value"][1]) if found else None


def health_token(station: StationProcess) -> str:
    made = station.api.post("/tokens", {"name": "p", "role": "viewer", "scopes": ["health"]})
    return str(made["token"])


def test_prometheus_reads_a_station_and_evaluates_the_rules(tmp_path: Path) -> None:
    data, folder = tmp_path / "station", tmp_path / "prometheus"
    data.mkdir()
    folder.mkdir()
    bus = f"tcp/127.0.0.1:{free_port()}"
    with (
        station_process(data, bus) as station,
        prometheus(folder, station.api.origin, health_token(station)) as address,
        ExitStack() as closing,
    ):
        unit = BenchUnit("FF-01", UnitEndpoint((bus,)), closing)
        until(lambda: unit.is_received, "the unit is linked", PATIENCE_S)
        unit.introduce()
        until(lambda: number(address, "up") == 1.0, "the station is scraped", PATIENCE_S)

        def is_counted() -> bool:
            unit.speak()
            return number(address, 'muster_units{link="live"}') == 1.0

        until(is_counted, "its unit is counted", PATIENCE_S)
        assert (number(address, "muster_messages_total") or 0.0) > 0.0
        assert number(address, "muster_alarms") is not None  # of the unit that nobody registered

        def has_no_down_alert() -> bool:  # one is pending until the rules are evaluated again
            alerts = {alert["metric"]["alertname"] for alert in query(address, "ALERTS")}
            return "MusterStationDown" not in alerts

        until(has_no_down_alert, "the station counts as up", PATIENCE_S)
