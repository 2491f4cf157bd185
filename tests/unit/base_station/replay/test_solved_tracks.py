"""Tracks of a solved incident: the unit's own path, the units in it, and its times."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.replay.solved_tracks import UNSURE_M
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.store import Store
from shared.messages.station import CloseIncident, OpenIncident, SetStart
from tests.rig.post_processor import post_processor_of
from tests.rig.station_script import START_NS, Script


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store(tmp_path / "station.sqlite") as store:
        yield store


@pytest.mark.parametrize(
    ("start_std_m", "quality"), [(0.5 * UNSURE_M, "good"), (4.0 * UNSURE_M, "degraded")]
)
def test_place_with_large_uncertainty_is_degraded(
    start_std_m: float, quality: str, store: Store, tmp_path: Path
) -> None:
    script = Script()
    script.register("FF-01")
    script.act(SetStart("FF-01", 5.0, 7.0, 0.0, 1.0, start_std_m / math.sqrt(2.0), 0.01))
    script.act(OpenIncident("i1", "Mill Lane"))
    for second in range(10):
        script.now_s += 1.0
        script.position("FF-01", 1.0 * second, 0.0)
    script.act(CloseIncident("i1"))
    incident = IncidentRow(
        incident_id="i1", name="Mill Lane", opened_ns=START_NS, closed_ns=script.t_ns
    )
    smoothed = post_processor_of(script, store, tmp_path).smoothed(incident).tracks["FF-01"]
    assert {one.quality for one in smoothed} == {quality}


def test_own_path_begins_anew_where_its_unit_restarted(store: Store, tmp_path: Path) -> None:
    """Each of its runs as the unit had it, from the known begin of that run."""
    script = Script()
    script.register("FF-01")
    script.act(SetStart("FF-01", 5.0, 7.0, 0.0, 1.0, 0.5, 0.1))
    script.act(OpenIncident("i1", "Mill Lane"))
    for boot_id in (7, 8):
        script.boot_ids["FF-01"] = boot_id
        for second in range(41):
            script.now_s += 1.0
            script.position("FF-01", 1.0 * second, 0.0)
    script.act(CloseIncident("i1"))
    post_processor = post_processor_of(script, store, tmp_path)
    incident = IncidentRow(
        incident_id="i1", name="Mill Lane", opened_ns=START_NS, closed_ns=script.t_ns
    )
    raw = post_processor.raw(incident)["FF-01"]
    smoothed = post_processor.smoothed(incident).tracks["FF-01"]
    assert [one.t_ns for one in raw] == [one.t_ns for one in smoothed]
    again = next(row for row, one in enumerate(raw) if one.t_ns >= START_NS + 42 * 10**9)
    for begin, end in ((0, again - 1), (again, -1)):
        assert (raw[begin].north_m, raw[begin].east_m) == pytest.approx(
            (smoothed[begin].north_m, smoothed[begin].east_m)
        )
        went_m = raw[end].north_m - raw[begin].north_m, raw[end].east_m - raw[begin].east_m
        assert math.hypot(*went_m) == pytest.approx(40.0, abs=0.02)
        assert raw[end].heading_rad == pytest.approx(math.atan2(went_m[1], went_m[0]) % math.tau)
    assert raw[0].heading_rad == pytest.approx(1.0, abs=0.05), "as its start says"
    assert {one.quality for one in smoothed[:again]} == {"good"}


def test_trails_are_of_the_incident_and_the_units_received_in_it(
    store: Store, tmp_path: Path
) -> None:
    """Both were on before, and one was switched off by then."""
    script = Script()
    script.register("FF-01", "FF-02")
    for second in range(50):
        script.now_s += 1.0
        if second == 20:
            script.act(OpenIncident("i1", "Mill Lane"))
            opened_ns = script.t_ns
        for unit_id in ("FF-01", "FF-02") if second < 20 else ("FF-01",):
            script.position(unit_id, 1.0 * second, 0.0)
    script.act(CloseIncident("i1"))
    post_processor = post_processor_of(script, store, tmp_path)
    incident = IncidentRow(
        incident_id="i1", name="Mill Lane", opened_ns=opened_ns, closed_ns=script.t_ns
    )
    for tracks in (post_processor.smoothed(incident).tracks, post_processor.raw(incident)):
        (track,) = tracks.values()
        assert list(tracks) == ["FF-01"]
        assert opened_ns <= track[0].t_ns < opened_ns + 3 * 10**9
        assert track[-1].t_ns == script.t_ns
    assert {one.quality for one in post_processor.smoothed(incident).tracks["FF-01"]} == {
        "degraded"
    }
