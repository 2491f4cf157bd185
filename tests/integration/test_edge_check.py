"""``muster edge check`` run by a person and by a script, beside a secured station."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from edge.storage.data_folder import UnitDataFolder
from tests.rig.enrolled_site import EnrolledSite
from tests.rig.kernel_devices import EmulatedAgent, SysfsTree, has_umockdev
from tests.rig.shown_unit import ShownUnit
from tests.rig.station_command import Agent, Browser, Command, UnitCheck
from tests.rig.waiting import until


@pytest.fixture
def site(tmp_path: Path, port: int) -> Iterator[EnrolledSite]:
    with ExitStack() as stack:
        (tmp_path / "station").mkdir()
        yield EnrolledSite(tmp_path / "station", stack, port)


@pytest.fixture
def check(tmp_path: Path, site: EnrolledSite) -> Callable[..., UnitCheck]:
    def started(*flags: str) -> UnitCheck:
        where = ("--data", str(tmp_path / "units"), "--enrolment", str(site.enrolment))
        return UnitCheck(
            tmp_path / "check.txt", "--source", "bench:4", "--for", "4", *where, *flags
        )

    return started


def test_a_unit_beside_its_station_is_checked_and_leaves_no_trace(site, check) -> None:
    site.open()
    with check() as checked:
        assert checked.wait() == 0, checked.output()
        for line in (
            "ok      certificate: valid to",
            "ok      sample rate: 200.0 samples/s of 200",
            "ok      accelerometer:",
            "warning calibration: none",
            "ok      link: linked within",
            "the station's",
            "Unit u1 works; read the warnings",
        ):
            assert line in checked.output()
    assert not site.positions
    assert not site.alive


def test_missing_station_fails_the_check_with_an_exit_code(check) -> None:
    with check("--json") as checked:
        assert checked.wait() == 1
        printed = checked.output()
    report = json.loads(printed[printed.index("{") :])
    assert (report["unit"], report["level"]) == ("u1", "failed")
    (link,) = (one for one in report["findings"] if one["subject"] == "link")
    assert link["level"] == "failed"
    assert "nothing listens" in link["text"]


def test_unit_with_a_running_agent_is_not_checked(site, check, tmp_path: Path) -> None:
    with closing(UnitDataFolder(tmp_path / "units" / "u1")), check() as checked:
        assert checked.wait() == 2
        assert "stop it" in checked.output()


@pytest.mark.skipif(not has_umockdev(), reason="no umockdev: install the package umockdev")
def test_devices_of_the_kernel_are_checked(tmp_path: Path, port: int) -> None:
    tree = SysfsTree(tmp_path / "machine" / "sys")
    tree.iio(
        0, name="max31856", in_temp_scale="7.812500", fault_oc="0", fault_ovuv="0",
        in_temp_raw="3200",
    )  # fmt: skip
    tree.power_supply("BAT0", type="Battery", capacity="12", status="Discharging")
    flags = (
        "--unit", "u1", "--source", "bench:4", "--for", "4", "--data", str(tmp_path / "units"),
        "--connect", f"tcp/127.0.0.1:{port}", "--battery", "auto",
        "--temperature", "iio:max31856?name=front", "--temperature", "w1:28-000000000001",
    )  # fmt: skip
    machine = EmulatedAgent(tree.root.parent, tmp_path / "check.txt", *flags, command="check")
    with machine as checked:
        until(lambda: not checked.runs(), "the end of the check")
        assert "ok      temperature front: 25.0 °C" in checked.output()
        assert "failed  battery: 12% of BAT0" in checked.output()
        assert "there is no 1-wire sensor 28-000000000001" in checked.output()
        assert "NOT ready" in checked.output()


def test_start_check_of_a_unit_is_shown_on_its_card(
    tmp_path: Path, serve: Callable[..., Command], data: Path, port: int
) -> None:
    where = ("--data", str(tmp_path / "units"), "--connect", f"tcp/127.0.0.1:{port}")
    with ExitStack() as stack:
        browser = stack.enter_context(Browser(serve().wait_ready(), data))
        browser.call("POST", "/units", json={"unit_id": "u1", "label": "u1"})
        shown = stack.enter_context(closing(ShownUnit(browser, "u1")))
        output = tmp_path / "agent.txt"
        agent = stack.enter_context(
            Agent(output, "--unit", "u1", "--source", "bench:5", "--battery", "none", *where)
        )
        until(lambda: shown.card.get("preflight"), "what the unit has found")
        preflight = shown.card["preflight"]
        assert preflight["level"] == "failed"
        assert preflight["text"].startswith("battery: no reading; ")
        assert "temperature: the unit has no sensor" in preflight["text"]
        assert "sample rate" not in preflight["text"]
        assert "check at the start: output: the unit has none" in agent.output()
