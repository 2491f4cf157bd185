"""Explanation of an alarm's reason for a person."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from base_station.app.offline_report import OpenedReport, open_report_sources
from base_station.report.alarm_explanation import ABOUT_NS, AlarmExplainer, AlarmExplanation
from base_station.storage.db.models import AlarmRow
from base_station.storage.db.window import EVER
from shared.clock import NS_PER_S
from tests.rig.reported_incident import HOT_DEGC, incident_records, write_log


@pytest.fixture(scope="module")
def opened(tmp_path_factory: pytest.TempPathFactory) -> Iterator[OpenedReport]:
    folder = tmp_path_factory.mktemp("given")
    write_log(folder, incident_records())
    with ExitStack() as closing:
        yield open_report_sources(folder, "i1", closing, lambda _: None, lambda _: None)


def explained(opened: OpenedReport, rule: str) -> tuple[AlarmRow, AlarmExplanation]:
    sources = opened.sources
    alarm = next(one for one in sources.records.alarms(EVER) if one.rule == rule)
    return alarm, AlarmExplainer(sources.records, sources.log.records).explain(alarm)


def test_threshold_is_that_of_the_time_with_the_value_that_crossed_it(
    opened: OpenedReport,
) -> None:
    alarm, found = explained(opened, "no-motion")
    assert dict(found.thresholds)["alarm_s"] == 25.0
    assert found.crossing is not None
    assert (found.crossing.series, found.crossing.threshold) == ("motionless_s", "pre_alert_s")
    assert found.crossing.value == found.crossing.limit == 20.0
    assert found.crossing.t_ns == alarm.raised_ns
    times_ns = [t_ns for t_ns, _ in found.motionless_s]
    assert min(times_ns) >= alarm.raised_ns - ABOUT_NS
    assert max(times_ns) <= alarm.raised_ns + ABOUT_NS
    assert max(value for _, value in found.motionless_s) > 60.0


def test_heat_names_the_worst_limit_that_was_reached(opened: OpenedReport) -> None:
    _, found = explained(opened, "heat")
    assert found.crossing is not None
    assert (found.crossing.threshold, found.crossing.value) == ("warning_degc", HOT_DEGC)


def test_mayday_has_its_button_and_no_threshold(opened: OpenedReport) -> None:
    alarm, found = explained(opened, "mayday")
    assert found.buttons_ns == (alarm.raised_ns,)
    assert found.crossing is None
    assert len(found.received_ns) > 100
    assert len(found.height_m) == len(found.stated_error_m) > 60
    assert all(0.0 < value < 50.0 for _, value in found.stated_error_m)
    assert max(t_ns for t_ns, _ in found.height_m) > alarm.raised_ns + 30 * NS_PER_S
