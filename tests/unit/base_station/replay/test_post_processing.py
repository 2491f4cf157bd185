"""Post-processing of an incident: smoothed beside the shown trail, kept, raw, and assessed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from base_station.exporters.incident import incident_tracks
from base_station.fusion.smoothing import SMOOTHERS
from base_station.replay.assessment.report import with_people
from base_station.replay.playback import Archive, Record
from base_station.replay.post_processing import LATELY_NS, PostProcessor, read_report
from base_station.replay.rebuild import project_log
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.projecting import project_into
from base_station.storage.db.records import Records, TrackSample
from base_station.storage.db.roster import Roster
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.store import Store
from shared.clock import ManualClock
from shared.errors import StoreError
from shared.messages.pins import SetPin
from shared.messages.station import CloseIncident, OpenIncident, SetAnchor, SetStart
from tests.rig.live_station import make_pipeline
from tests.rig.post_processor import post_processor_of
from tests.rig.round_walk import Walk, truth
from tests.rig.station_script import START_NS, Script


class ClosedIncident:
    """A closed incident of two units, with pins, in a store and a log."""

    def __init__(self, folder: Path, clock: ManualClock) -> None:
        self.walk = Walk("FF-01", "FF-02", turn_rad=0.5)
        for unit_id in self.walk.units:
            self.walk.start(unit_id)
        self.walk.go(300)
        self.walk.pin("p1", "FF-01", 250.0)
        self.walk.script.act(CloseIncident("i1"))
        records = self.walk.script.records
        self.store = Store(folder / "station.sqlite")
        self.records = Records(self.store, clock)
        self.roster = Roster(self.store, clock)

        def write(projection: object) -> None:
            with self.store.write() as session:
                project_into(session, (projection,))  # type: ignore[arg-type]  # of the projector

        project_log(records, make_pipeline(), write, lambda _: None)
        self.archive = archive = Archive(
            lambda t_ns: [record for record in records if record[0] >= t_ns],
            Checkpoints(folder / "checkpoints"),
            make_pipeline,
        )
        self.kept = SmoothedTracks(self.store)
        self.post_processor = PostProcessor(archive, SMOOTHERS[0], self.kept, clock)
        incident = self.records.incident("i1")
        assert incident is not None
        self.incident: IncidentRow = incident

    def mean_off_m(self, track: Sequence[TrackSample]) -> float:
        begin_ns = self.walk.script.t_ns - self.walk.walked_s * 10**9
        apart = [
            math.dist((one.north_m, one.east_m), truth((one.t_ns - begin_ns) / 1e9))
            for one in track
        ]
        return sum(apart) / len(apart)


@pytest.fixture(scope="module")
def past(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ClosedIncident]:
    past = ClosedIncident(tmp_path_factory.mktemp("past"), ManualClock())
    yield past
    past.store.close()


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    """Another store without content."""
    with Store(tmp_path / "station.sqlite") as store:
        yield store


@pytest.mark.slow
def test_smoothed_trail_is_better_than_the_shown_and_both_are_kept(past: ClosedIncident) -> None:
    shown = past.records.tracks_of(past.incident)
    smoothed = past.post_processor.smoothed(past.incident)
    assert set(smoothed.tracks) == {"FF-01", "FF-02"}
    assert past.mean_off_m(smoothed.tracks["FF-01"]) < 0.5 * past.mean_off_m(shown["FF-01"])
    assert past.records.tracks_of(past.incident) == shown
    assert past.kept.of("i1") is not None


def test_finished_result_is_not_made_again(past: ClosedIncident) -> None:
    first = past.post_processor.smoothed(past.incident)
    again = past.post_processor.smoothed(past.incident)
    assert again.made_ns == first.made_ns
    assert again.tracks == first.tracks
    fractions: list[float] = []
    assert past.post_processor.smooth(past.incident, fractions.append).tracks == first.tracks
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0


@pytest.mark.slow
def test_requests_during_the_work_get_the_same_result(past: ClosedIncident, store: Store) -> None:
    """It takes minutes for a long incident, and is done once for any number of requests."""
    opened: list[int] = []

    def counting(t_ns: int) -> Iterable[Record]:
        opened.append(t_ns)
        return past.archive.open_log(t_ns)

    archive = Archive(counting, past.archive.checkpoints, make_pipeline)
    post_processor = PostProcessor(archive, SMOOTHERS[0], SmoothedTracks(store), ManualClock())
    with ThreadPoolExecutor(3) as pool:
        made = list(pool.map(post_processor.smoothed, [past.incident] * 3))
    assert len(opened) == 1
    assert all(one.tracks == made[0].tracks for one in made)


@pytest.mark.slow
def test_recently_closed_incident_is_smoothed_without_a_request(
    past: ClosedIncident, clock: ManualClock, monkeypatch: pytest.MonkeyPatch
) -> None:
    past.kept.put("i1", "gone", 0, {}, {}, None)
    past.post_processor.catch_up(past.records.incidents(), past.records.tracks_of)
    assert past.kept.of("i1") == ("gone", 0, {})
    monkeypatch.setattr(past.kept, "has", lambda *_: False)
    past.post_processor.catch_up(past.records.incidents(), past.records.tracks_of)
    made = past.kept.of("i1")
    assert made is not None
    assert made[0] == SMOOTHERS[0].name
    assert past.kept.report("i1") is not None


def test_incident_closed_long_ago_waits_for_a_request(past: ClosedIncident, store: Store) -> None:
    assert past.incident.closed_ns is not None
    clock = ManualClock(utc_ns=past.incident.closed_ns + LATELY_NS)
    kept = SmoothedTracks(store)
    post_processor = PostProcessor(past.archive, SMOOTHERS[0], kept, clock)
    post_processor.catch_up([past.incident], past.records.tracks_of)
    assert not kept.has("i1")
    assert post_processor.smoothed(past.incident).is_kept


def test_failing_incident_is_given_up_and_the_next_is_not(
    past: ClosedIncident, store: Store, caplog: pytest.LogCaptureFixture
) -> None:
    post_processor = PostProcessor(
        past.archive, SMOOTHERS[0], SmoothedTracks(store), ManualClock(utc_ns=0)
    )
    asked: list[str] = []

    def shown(incident: IncidentRow) -> dict[str, Sequence[TrackSample]]:
        asked.append(incident.incident_id)
        raise ZeroDivisionError("a mistake")

    incidents = [
        IncidentRow(incident_id=one, name=one, opened_ns=1, closed_ns=2) for one in ("i1", "i2")
    ]
    for _ in range(4):
        post_processor.catch_up(incidents, shown)
    assert asked == ["i1", "i2"]
    assert "the trails of i1 cannot be smoothed" in caplog.text


class FullStore(SmoothedTracks):
    """Store on a disk that refuses writes."""

    full = True
    tries = 0

    def put(self, *what: Any, **how: Any) -> bool:
        self.tries += 1
        if self.full:
            raise StoreError("the disk is full")
        return super().put(*what, **how)


@pytest.mark.slow
def test_full_disk_is_reported_once_and_the_result_kept_when_there_is_room(
    past: ClosedIncident, store: Store, caplog: pytest.LogCaptureFixture
) -> None:
    kept, clock = FullStore(store), ManualClock(utc_ns=0)
    post_processor = PostProcessor(past.archive, SMOOTHERS[0], kept, clock)

    def catch_up() -> None:
        post_processor.catch_up(past.records.incidents(), past.records.tracks_of)

    for _ in range(3):
        catch_up()
    assert kept.tries == 1  # it may take minutes, and a full disk is busy enough
    made = post_processor.smoothed(past.incident)
    assert (made.is_kept, set(made.tracks)) == (False, {"FF-01", "FF-02"})
    assert post_processor.assess(past.incident, past.records.tracks_of(past.incident)).units
    assert post_processor.raw(past.incident)
    assert [one.exc_info for one in caplog.records] == [None]
    assert "cannot be kept: the disk is full" in caplog.text
    kept.full = False
    clock.advance(301.0)
    catch_up()
    assert post_processor.smoothed(past.incident).is_kept
    assert kept.report("i1") is not None
    assert [one.message.partition(":")[0] for one in caplog.records][1:] == ["over"]


@pytest.mark.slow
def test_open_incident_has_all_its_records_whatever_the_clock(
    past: ClosedIncident, store: Store
) -> None:
    """`muster base smooth` on a machine whose clock was set back: times continue from the last."""
    behind = ManualClock(utc_ns=past.incident.opened_ns + 10 * 10**9)
    post_processor = PostProcessor(past.archive, SMOOTHERS[0], SmoothedTracks(store), behind)
    is_open = IncidentRow(
        incident_id="i1", name="Mill Lane", opened_ns=past.incident.opened_ns, closed_ns=None
    )
    fractions: list[float] = []
    tracks = post_processor.smooth(is_open, fractions.append).tracks
    assert tracks["FF-01"][-1].t_ns == past.incident.closed_ns
    assert fractions == sorted(fractions)


def test_raw_trail_is_the_own_path_from_its_start(past: ClosedIncident) -> None:
    raw = past.post_processor.raw(past.incident)["FF-01"]
    smoothed = past.post_processor.smoothed(past.incident).tracks["FF-01"]
    assert (raw[0].north_m, raw[0].east_m) == (smoothed[0].north_m, smoothed[0].east_m)
    assert past.mean_off_m(raw) > 2.0 * past.mean_off_m(smoothed)


@pytest.mark.slow
@pytest.mark.parametrize("reported", ["start", "pin", "fix", "nothing"])
def test_unknown_begin_is_reported_as_such(reported: str, store: Store, tmp_path: Path) -> None:
    """As it was shown live: about the unit's own start."""
    script = Script()
    script.register("FF-01")
    script.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
    script.act(OpenIncident("i1", "Mill Lane"))
    if reported == "start":
        script.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))
    for second in range(40):
        script.now_s += 1.0
        script.position("FF-01", 1.0 * second, 0.0, distance_m=1.0 * second)
        if reported == "fix":
            script.gps("FF-01", 52.0 + second / 111_275.0, 4.0, horizontal_std_m=1.5)
    if reported == "pin":
        script.act(SetPin("p", "FF-01", script.t_ns, 40.0, 0.0, 0.5, None, None, 0.0, ""))
    script.act(CloseIncident("i1"))
    post_processor = post_processor_of(script, store, tmp_path)
    incident = IncidentRow(
        incident_id="i1", name="Mill Lane", opened_ns=START_NS, closed_ns=script.t_ns
    )
    last = post_processor.smoothed(incident).tracks["FF-01"][-1]
    assert last.quality == ("degraded" if reported == "nothing" else "good")


@pytest.mark.slow
def test_raw_trails_and_assessment_are_kept_until_the_next_solution(past: ClosedIncident) -> None:
    shown = past.records.tracks_of(past.incident)
    report, raw = (
        past.post_processor.assess(past.incident, shown),
        past.post_processor.raw(past.incident),
    )
    assert past.post_processor.assess(past.incident, {}) == report
    assert past.kept.raw("i1") == raw
    past.post_processor.smooth(past.incident)
    assert past.kept.report("i1") is None
    past.post_processor.assess(past.incident, shown)
    past.kept.put("i1", "of another version", 0, {}, {}, b"of another version")
    assert past.post_processor.assess(past.incident, shown).units == report.units


class SmoothedBeside(SmoothedTracks):
    """A store in which another process replaces the result as soon as something has been kept of
    it.
    """

    def __init__(self, store: Store, incident: IncidentRow) -> None:
        super().__init__(store)
        self.incident = incident
        self.beside: PostProcessor | None = None

    def put(self, *what: Any, **how: Any) -> bool:
        kept = super().put(*what, **how)
        if self.beside is not None:
            beside, self.beside = self.beside, None
            beside.smooth(self.incident)
        return kept


@pytest.mark.slow
def test_assessment_is_not_kept_beside_newer_trails(past: ClosedIncident, store: Store) -> None:
    """`muster base smooth` beside a station that is just assessing the same incident."""
    clock, kept = ManualClock(), SmoothedBeside(store, past.incident)
    station = PostProcessor(past.archive, SMOOTHERS[0], kept, clock)
    later = ManualClock(utc_ns=clock.utc_ns() + 60 * 10**9)
    kept.beside = PostProcessor(past.archive, SMOOTHERS[0], SmoothedTracks(store), later)
    shown = past.records.tracks_of(past.incident)
    station.assess(past.incident, shown)
    trails = station.smoothed(past.incident)
    assert trails.made_ns == later.utc_ns()
    assert kept.report("i1") is None
    again = station.assess(past.incident, shown)
    assert kept.report("i1") is not None
    assert again.made_ms == station.smoothed(past.incident).made_ns // 10**6


@pytest.mark.slow
def test_result_of_a_log_rewritten_meanwhile_is_not_kept(
    past: ClosedIncident, store: Store
) -> None:
    """It may hold the way of an erased person."""
    rewritten = False
    archive = replace(past.archive, watch=lambda: lambda: rewritten)
    kept = SmoothedTracks(store)
    station = PostProcessor(archive, SMOOTHERS[0], kept, ManualClock(utc_ns=0))
    shown = past.records.tracks_of(past.incident)
    rewritten = True
    station.assess(past.incident, shown)
    assert not station.smooth(past.incident).is_kept
    assert not kept.has("i1")
    rewritten = False
    station.catch_up([past.incident], lambda _: shown)
    assert kept.has("i1")


def test_assessment_has_the_durations_of_the_lights(past: ClosedIncident) -> None:
    report = past.post_processor.assess(past.incident, past.records.tracks_of(past.incident))
    named = with_people(report, {"FF-01": ["Mia"]})
    assert [unit.people for unit in named.units] == [("Mia",), ()]
    assert all(0.0 <= (unit.floor_right or 0.0) <= 1.0 for unit in report.units)


def test_exporter_uses_the_smoothed_trail(past: ClosedIncident) -> None:
    smoothed = past.post_processor.smoothed(past.incident).tracks
    shown = [*incident_tracks(past.records, past.roster, past.incident).tracks]
    chosen = [*incident_tracks(past.records, past.roster, past.incident, smoothed).tracks]
    assert [track.unit_id for track in chosen] == [track.unit_id for track in shown]
    assert [point.t_ns for point in chosen[0].points] == [
        sample.t_ns for sample in smoothed["FF-01"]
    ]


def test_assessment_compares_shown_places_with_the_smoothed_trail(past: ClosedIncident) -> None:
    report = past.post_processor.assess(past.incident, past.records.tracks_of(past.incident))
    one, two = report.units
    assert one.against_smoothed is not None
    assert one.stated is not None
    true_m = past.mean_off_m(past.records.tracks_of(past.incident)["FF-01"])
    assert one.against_smoothed.ce50_m == pytest.approx(true_m, rel=0.6)
    assert one.against_smoothed.ce50_m <= one.against_smoothed.ce95_m
    (residual,) = one.pin_residuals
    assert residual.used
    assert residual.shown_m is not None
    assert residual.shown_m > residual.trail_m
    assert two.pin_residuals == ()
    assert one.loop_closure_m is not None
    assert one.walked_m == pytest.approx(300.0, rel=0.05)


def test_report_that_an_earlier_version_kept_has_flaws_without_codes() -> None:
    kept = {
        "incident_id": "i1",
        "smoother": "rts",
        "made_ms": 1,
        "units": (),
        "stated": None,
        "against_smoothed": None,
        "flaws": ("segment 2 of the log is missing",),
    }
    report = read_report(msgspec.msgpack.encode(kept))
    assert report is not None
    assert (report.flaws, report.flaw_codes) == (("segment 2 of the log is missing",), ())
