"""The text of ``/metrics``, read back by a parser of Prometheus' format."""

from __future__ import annotations

import shutil
import subprocess

import msgspec
import pytest
from prometheus_client.parser import text_string_to_metric_families

from base_station.api.metrics import exposition
from base_station.api.position_ages import PositionAges
from base_station.views.wire import Delta, ForwarderView, Snapshot, StandbyView
from tests.e2e import scenes

Samples = dict[tuple[str, frozenset[tuple[str, str]]], float]


def samples(picture: Snapshot, ages: PositionAges | None = None) -> Samples:
    text = exposition(picture, ages or PositionAges(), consoles=3).decode()
    return {
        (sample.name, frozenset(sample.labels.items())): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def value(found: Samples, name: str, /, **labels: str) -> float:
    return found[name, frozenset(labels.items())]


def test_units_and_alarms_are_counted_by_their_labels() -> None:
    picture = scenes.bad_minute()
    found = samples(picture)
    by_link = {link: value(found, "muster_units", link=link) for link in ("live", "lost", "never")}
    assert sum(by_link.values()) == len(picture.units)
    assert by_link["lost"] == sum(unit.link == "lost" for unit in picture.units)
    still_open = [alarm for alarm in picture.alarms if alarm.state != "resolved"]
    assert still_open
    counted = [count for (name, _), count in found.items() if name == "muster_alarms"]
    assert sum(counted) == len(still_open)
    assert value(found, "muster_consoles") == 3


def test_messages_and_storage_equal_the_health_page() -> None:
    picture = scenes.quiet()
    health = msgspec.structs.replace(
        picture.health, messages=70, left_out=7, missing=2, disk_free_bytes=5_000, reading=0.25
    )
    found = samples(msgspec.structs.replace(picture, health=health))
    assert value(found, "muster_messages_total") == 70
    assert value(found, "muster_messages_left_out_total") == 7
    assert value(found, "muster_messages_missing_total") == 2
    assert value(found, "muster_disk_free_bytes") == 5_000
    assert value(found, "muster_log_read_ratio") == 0.25
    assert value(found, "process_resident_memory_bytes") > 0


def test_ages_are_a_histogram_whose_last_bucket_counts_all() -> None:
    picture, ages = scenes.quiet(), PositionAges()
    ages.observe(Delta(1, scenes.NOW_MS, units=picture.units))
    found = samples(picture, ages)
    assert value(found, "muster_position_age_seconds_count") == len(picture.units)
    assert value(found, "muster_position_age_seconds_bucket", le="+Inf") == len(picture.units)


def test_station_of_a_pair_states_its_role() -> None:
    picture = scenes.quiet()
    standby = StandbyView("b", "standby", "", "a", "active", "", in_step=False)
    health = msgspec.structs.replace(picture.health, standby=standby)
    found = samples(msgspec.structs.replace(picture, health=health))
    assert value(found, "muster_station_active") == 0
    assert value(found, "muster_standby_in_step") == 0
    assert ("muster_station_active", frozenset()) not in samples(picture)


def test_no_person_is_named() -> None:
    picture = scenes.bad_minute()
    text = exposition(picture, PositionAges(), consoles=0).decode()
    names = {unit.person.name for unit in picture.units if unit.person is not None}
    assert names
    assert not [name for name in names if name in text]


@pytest.mark.slow  # another program
@pytest.mark.skipif(shutil.which("promtool") is None, reason="promtool is not installed")
def test_checker_of_prometheus_reports_nothing() -> None:
    text = exposition(scenes.bad_minute(), PositionAges(), consoles=3)
    checked = subprocess.run(
        ["promtool", "check", "metrics"], input=text, capture_output=True, check=False
    )
    assert (checked.returncode, checked.stderr.decode()) == (0, "")


def test_forwarders_are_counted_by_kind_and_name() -> None:
    away = ForwarderView("county", "tak", "tcp://127.0.0.1:8087", "connecting", None, 7, 0, 0, "")
    there = msgspec.structs.replace(away, name="army", state="connected")
    picture = scenes.quiet()
    health = msgspec.structs.replace(picture.health, forwarders=(away, there))
    found = samples(msgspec.structs.replace(picture, health=health))
    assert value(found, "muster_forwarder_connected", kind="tak", name="county") == 0
    assert value(found, "muster_forwarder_connected", kind="tak", name="army") == 1
    assert value(found, "muster_forwarder_sent_total", kind="tak", name="county") == 7
