"""The check of a unit at its start, which disturbs nothing."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import numpy as np
import pytest

from edge.config import EdgeConfig
from edge.preflight.finding import CheckFinding, Severity
from edge.preflight.start_check import SURVEY_S, StartCheck
from edge.samples import (
    AmbientSample,
    BatterySample,
    GpsSample,
    ImuBatch,
    OtherSample,
    SensorBatch,
    SensorDescription,
)
from edge.sources.interface import Quantity
from shared.clock import NS_PER_S
from shared.messages import PreflightFinding, PreflightLevel
from tests.rig.waiting import until

RATE_HZ = 100.0
SENSOR = SensorDescription("sensor", RATE_HZ, 160.0, 35.0)
CONFIG = EdgeConfig(
    "bench:1", temperatures=("w1:1?name=front",), battery="auto", outputs=("terminal:a",)
)
GIVES = frozenset({Quantity.MAYDAY_BUTTON, Quantity.FIX})
FIX = GpsSample(1, 50.0, 8.0, 200.0, 3.0, 6.0, 3, 9, 0.0, 0.0)
OTHERS: tuple[OtherSample, ...] = (
    AmbientSample(1, 21.5, "front"), BatterySample(1, 0.9, 20_000.0), FIX,
)  # fmt: skip
END_NS = round(SURVEY_S * NS_PER_S)


def all_well() -> Iterator[CheckFinding]:
    yield CheckFinding("disk", Severity.OK, "20 GB free")


def samples(duration_s: float, *others: OtherSample, rate_hz: float = RATE_HZ) -> SensorBatch:
    """A foot that walks: it never lies still."""
    count = round(duration_s * rate_hz)
    t_ns = (np.arange(count) / rate_hz * NS_PER_S).astype(np.int64)
    swing = np.sin(np.arange(count) / rate_hz * 6.0)[:, None]
    accel = np.array([[0.0, 0.0, 9.81]]) + 3.0 * swing * np.array([[1.0, 0.5, 0.3]])
    gyro = 2.0 * swing * np.array([[0.2, 1.0, 0.1]])
    return SensorBatch(ImuBatch(t_ns, accel, gyro), others)


def started(config: EdgeConfig = CONFIG, installation=all_well, gives=GIVES) -> StartCheck:
    check = StartCheck(config, {"": SENSOR}, gives, installation)
    check.start(0)
    return check


def subjects(findings: tuple[PreflightFinding, ...] | None) -> list[str]:
    assert findings is not None
    return [finding.subject for finding in findings]


def at_end(check: StartCheck) -> tuple[PreflightFinding, ...] | None:
    until(lambda: not check._thread.is_alive(), "the look at the disk")
    assert check.step(END_NS - 1) is None
    return check.step(END_NS)


def test_a_unit_that_has_everything_is_ready_though_its_wearer_walks() -> None:
    check = started()
    check.push(samples(SURVEY_S, *OTHERS))
    assert at_end(check) == ()
    assert check.step(2 * END_NS) is None, "said once"


def test_missing_items_are_reported_by_severity() -> None:
    def full_disk() -> Iterator[CheckFinding]:
        yield CheckFinding("disk", Severity.WARNING, "1 GB free", "make room")

    check = started(EdgeConfig("bench:1", battery="auto"), full_disk, frozenset())
    check.push(samples(SURVEY_S, rate_hz=20.0))
    found = at_end(check)
    assert subjects(found) == [
        "sample rate", "battery", "disk", "temperature", "satellites", "mayday button", "output",
    ]  # fmt: skip
    assert found is not None
    assert [one.level for one in found[:3]] == [
        PreflightLevel.FAILED, PreflightLevel.FAILED, PreflightLevel.WARNING,
    ]  # fmt: skip
    assert found[2] == PreflightFinding(PreflightLevel.WARNING, "disk", "1 GB free", "make room")


def test_a_source_that_gives_nothing_is_stated() -> None:
    check = started()
    found = at_end(check)
    assert found is not None
    assert found[0].subject == "inertial sensor"
    assert found[0].level is PreflightLevel.FAILED


def test_items_that_recover_are_removed_and_none_is_added() -> None:
    check = started()
    check.push(samples(SURVEY_S, *OTHERS[1:]))
    assert subjects(at_end(check)) == ["temperature front"]
    check.push(SensorBatch(samples(0.1).imu, (OTHERS[0], BatterySample(1, 0.01, 60.0))))
    assert check.step(END_NS + 1) is None, "it does not look all the time"
    assert check.step(2 * END_NS) == ()
    assert check.step(3 * END_NS) is None


def test_a_disk_that_hangs_holds_up_nothing_and_is_stated() -> None:
    answers = threading.Event()

    def hanging() -> Iterator[CheckFinding]:
        answers.wait()
        yield CheckFinding("disk", Severity.OK, "20 GB free")

    check = started(installation=hanging)
    check.push(samples(SURVEY_S, *OTHERS))
    assert subjects(check.step(END_NS)) == ["disk"]
    answers.set()
    until(lambda: not check._thread.is_alive(), "the look at the disk")
    assert check.step(2 * END_NS) == ()


def test_a_disk_that_cannot_be_looked_at_is_a_failure() -> None:
    def broken() -> list[CheckFinding]:
        raise OSError(5, "Input/output error")

    check = started(installation=broken)
    check.push(samples(SURVEY_S, *OTHERS))
    found = at_end(check)
    assert found is not None
    assert (found[0].subject, found[0].level) == ("disk", PreflightLevel.FAILED)


def test_a_check_that_fails_is_stated_and_stops_no_unit(monkeypatch: pytest.MonkeyPatch) -> None:
    check = started()
    monkeypatch.setattr(check._auxiliary, "push", lambda _: 1 / 0)
    check.push(samples(SURVEY_S, *OTHERS))
    check.push(samples(SURVEY_S, *OTHERS))
    assert subjects(at_end(check)) == ["check at the start"]
    assert check.step(5 * END_NS) is None


def test_check_reports_nothing_before_its_start() -> None:
    check = StartCheck(CONFIG, {"": SENSOR}, GIVES, all_well)
    assert check.step(5 * END_NS) is None
