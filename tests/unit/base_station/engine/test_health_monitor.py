"""Problems of the station itself are reported once, and end when they stay away."""

from __future__ import annotations

import pytest

from base_station.engine.health_monitor import WELL_AFTER, HealthMonitor
from shared.messages.station import ReportProblem

FULL = {"log": "the disk is full"}
WELL = {"log": ""}


def reports(checks: list[dict[str, str]], known: dict[str, str] | None = None) -> list[str]:
    """Reports over the checks, with the state that follows the reports."""
    health, known, reported = HealthMonitor(), dict(known or {}), []
    for now in checks:
        for report in health.check(now, known):
            assert isinstance(report, ReportProblem)
            reported.append(report.text)
            if report.text:
                known[report.part] = report.text
            else:
                del known[report.part]
    return reported


def test_problem_is_reported_once_and_its_end_once() -> None:
    assert reports([FULL] * 20) == ["the disk is full"]
    assert reports([FULL] * 3 + [WELL] * 20) == ["the disk is full", ""]


def test_intermittent_part_is_one_problem() -> None:
    assert reports([FULL, WELL, WELL] * 20) == ["the disk is full"]


def test_problem_ends_only_after_a_while() -> None:
    assert reports([FULL] + [WELL] * (WELL_AFTER - 1)) == ["the disk is full"]
    assert reports([FULL] + [WELL] * WELL_AFTER) == ["the disk is full", ""]


def test_part_that_is_only_named_when_it_fails_recovers_too() -> None:
    assert reports([{"pipeline": "a mistake"}] + [{}] * WELL_AFTER) == ["a mistake", ""]


def test_problem_from_before_a_restart_ends_where_its_part_is_watched() -> None:
    assert reports([WELL] * WELL_AFTER, {"log": "the disk is full"}) == [""]


@pytest.mark.parametrize("part", ["drive", "pipeline", "bus", "checkpoint"])
def test_problem_from_before_a_restart_ends_where_its_part_is_only_named_when_it_fails(
    part: str,
) -> None:
    assert reports([WELL] * (WELL_AFTER - 1), {part: "it failed"}) == []
    assert reports([WELL] * WELL_AFTER, {part: "it failed"}) == [""]


def test_problems_reported_by_others_are_left_to_them() -> None:
    assert reports([WELL] * 20, {"rule-heat": "the rule failed"}) == []


def test_worse_problem_is_reported_and_other_numbers_are_not() -> None:
    waiting = [{"log": f"the log cannot be written, {count} records wait"} for count in range(5)]
    missing = [{"log": f"the disk did not keep up: {count} are missing"} for count in range(5)]
    assert reports(waiting + missing) == [waiting[0]["log"], missing[0]["log"]]


def test_part_that_fails_in_ever_other_ways_is_reported_once() -> None:
    health, known = HealthMonitor(), dict[str, str]()
    for message in ("one message", "another", "one more"):
        health.report("pipeline", message)
        known |= {report.part: report.text for report in health.check(WELL, known)}
    assert known == {"pipeline": "one message"}


def test_dismissed_problem_is_reported_again_while_it_lasts() -> None:
    health = HealthMonitor()
    assert [r.text for r in health.check(FULL, {})] == ["the disk is full"]
    assert [r.text for r in health.check(FULL, FULL)] == []
    assert [r.text for r in health.check(FULL, {})] == ["the disk is full"]


def test_repeated_error_is_logged_once_and_once_more_after_its_end(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Some errors repeat with every message: hundreds a second fill a disk."""
    health, known = HealthMonitor(), {"pipeline": "it failed"}

    def logged() -> int:
        return len([one for one in caplog.records if one.exc_info])

    for number in range(50):
        health.report_bug("pipeline", ValueError(f"of {number}"))
        list(health.check(WELL, known))
    assert logged() == 1
    health.report_bug("pipeline", KeyError("another"))
    health.report_bug("drive", ValueError("elsewhere"))
    assert logged() == 3
    for _ in range(WELL_AFTER):
        list(health.check(WELL, known))
    list(health.check(WELL, known))
    health.report_bug("pipeline", ValueError("anew"))
    assert logged() == 4
