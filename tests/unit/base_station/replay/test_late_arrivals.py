"""Messages received after an incident was closed that belong to its time are in its smoothed
trails.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from base_station.core.events import ClosedIncidentChanged, Output
from base_station.fusion.smoothing import SMOOTHERS
from base_station.replay.playback import Archive
from base_station.replay.post_processing import QUIET_NS, PostProcessor
from base_station.replay.rebuild import project_log
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.projecting import project_into
from base_station.storage.db.records import Records, TrackSample
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.store import Store
from shared.channels import NO_TRACKER, SIGHTING, backfilled_key, tracker_id
from shared.clock import ManualClock
from shared.codec import encode
from shared.messages import Sighting, SightingKind
from shared.messages.pins import PlaceBeacon, RemovePin, SetPin, StartTogether
from shared.messages.station import CloseIncident, OpenIncident, SetAnchor, SetPlan, SetStart
from tests.rig import message_factory
from tests.rig.journaled_script import JournaledScript
from tests.rig.live_station import make_pipeline
from tests.rig.round_walk import PLAN, Walk, truth

INSIDE_S, OUT_OF_REACH_S = 150, 150
QUIET_S = QUIET_NS / 1e9 + 15.0  # projections may be so late


AGENT = tracker_id("FF-01")


class TrackedByAgent(JournaledScript):
    """An agent tracks for FF-01."""

    def position(
        self, unit_id: str, north_m: float, east_m: float, **changes: object
    ) -> list[Output]:
        speaker = AGENT if unit_id == "FF-01" else unit_id
        return super().position(speaker, north_m, east_m, **changes)


class Station:
    """Two units walk; one of them is out of range for the second half of the incident."""

    def __init__(
        self,
        folder: Path,
        never_received: str = "",
        out_of_reach: str = "FF-01",
        script: JournaledScript | None = None,
    ) -> None:
        self.script = script or JournaledScript()
        self.walk = Walk("FF-01", "FF-02", turn_rad=0.5, script=self.script)
        self.begin_ns = self.script.t_ns
        if isinstance(script, TrackedByAgent):
            header = script.header("FF-01")
            script.say(message_factory.description(header, tracker=NO_TRACKER))
        for unit_id in self.walk.units:
            self.walk.start(unit_id)
        self.script.out_of_reach = {never_received}
        self.go(INSIDE_S)
        self.script.out_of_reach = {never_received or out_of_reach}
        self.go(OUT_OF_REACH_S)
        self.script.act(CloseIncident("i1"))
        self.closed_ns = self.script.t_ns
        self.clock = ManualClock(utc_ns=self.closed_ns)
        self.store = Store(folder / "station.sqlite")
        self.records = Records(self.store, self.clock)
        self.kept = SmoothedTracks(self.store)
        archive = Archive(
            lambda t_ns: [one for one in self.script.records if one[0] >= t_ns],
            Checkpoints(folder / "checkpoints"),
            make_pipeline,
        )
        self.post_processor = PostProcessor(archive, SMOOTHERS[0], self.kept, self.clock)

    def go(self, seconds: int) -> None:
        for _ in range(seconds):
            self.walk.go(1)
            for unit_id in self.walk.units:
                self.script.status(unit_id)

    def back(self) -> None:
        """It has contact again, and its journal is read."""
        self.script.now_s += 60.0
        self.script.out_of_reach.clear()
        self.script.status("FF-01")
        self.script.fetch("FF-01")

    def wait(self, seconds: float) -> None:
        self.script.wait(seconds)
        self.clock.advance((self.script.t_ns - self.clock.utc_ns()) / 1e9)

    @property
    def incident(self) -> IncidentRow:
        """The incident in the store, by the log so far."""

        def write(projection: object) -> None:
            with self.store.write() as session:
                project_into(session, (projection,))  # type: ignore[arg-type]  # of the projector

        project_log(self.script.records, make_pipeline(), write, lambda _: None)
        return self.records.require_incident("i1")

    def trail(self, unit_id: str = "FF-01") -> Sequence[TrackSample]:
        """The smoothed trail."""
        return self.post_processor.smoothed(self.incident).tracks[unit_id]

    def at(self, second: float, unit_id: str) -> tuple[float, float]:
        """Place between the points of the trail at that time."""
        t_ns = self.begin_ns + round(second * 1e9)
        trail = self.trail(unit_id)
        row = bisect_left(trail, t_ns, key=lambda one: one.t_ns)
        before, after = trail[row - 1], trail[row]
        assert after.t_ns - before.t_ns < 10e9, "nothing is known of that time"
        part = (t_ns - before.t_ns) / (after.t_ns - before.t_ns)
        return (
            before.north_m + part * (after.north_m - before.north_m),
            before.east_m + part * (after.east_m - before.east_m),
        )

    def off_m(self, second: float, unit_id: str = "FF-01") -> float:
        return math.dist(self.at(second, unit_id), truth(second))

    def apart_m(self, other: Station, second: float, unit_id: str = "FF-01") -> float:
        return math.dist(self.at(second, unit_id), other.at(second, unit_id))

    def catch_up(self) -> None:
        self.post_processor.catch_up([self.incident], self.records.tracks_of)

    def pin(self, second: float, unit_id: str = "FF-01", pin_id: str = "p1") -> SetPin:
        t_ns = self.begin_ns + round(second * 1e9)
        return SetPin(pin_id, unit_id, t_ns, *truth(second), 0.5, None, None, 0.0, "")


@pytest.fixture
def station(tmp_path: Path) -> Iterator[Station]:
    station = Station(tmp_path)
    yield station
    station.store.close()


@pytest.fixture(scope="module")
def in_time(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Station]:
    """The script without a loss of contact."""
    station = Station(tmp_path_factory.mktemp("in time"), out_of_reach="")
    yield station
    station.store.close()


def ends_s(station: Station, trail: Sequence[TrackSample]) -> float:
    return (trail[-1].t_ns - station.begin_ns) / 1e9


@pytest.mark.slow
def test_backfilled_positions_after_the_end_are_in_the_smoothed_trail(station: Station) -> None:
    before = station.trail()
    assert ends_s(station, before) == pytest.approx(INSIDE_S, abs=1.0)
    station.back()
    station.wait(QUIET_S)
    assert ends_s(station, station.trail()) == pytest.approx(INSIDE_S + OUT_OF_REACH_S, abs=1.0)
    assert len(station.trail()) > 1.8 * len(before)
    report = station.post_processor.assess(
        station.incident, station.records.tracks_of(station.incident)
    )
    assert report.units[0].walked_m == pytest.approx(INSIDE_S + OUT_OF_REACH_S, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("since", ["goes on", "started again", "another incident"])
def test_later_events_of_unit_and_station_do_not_matter(
    station: Station, in_time: Station, since: str
) -> None:
    """The trail is as if all of it had come in time."""
    if since != "goes on":
        station.script.boot_ids["FF-01"] = 8
    if since == "another incident":
        station.script.now_s += 60.0
        station.script.act(SetAnchor(10.0, 10.0, 0.0, 1.0))
        station.script.act(OpenIncident("i2", "Station Road"))
        station.script.act(SetPlan(PLAN))
        station.script.act(SetStart("FF-01", 500.0, 0.0, 0.0, 0.0, 0.5, 0.1))
    journal = station.script.out_of_reach
    station.script.out_of_reach = set()
    for second in range(60):
        station.script.now_s += 1.0
        station.script.position("FF-01", 900.0 - second, 0.0)
        station.script.status("FF-01")
        station.script.gps("FF-01", 10.0, 10.0)
    station.script.out_of_reach = journal
    station.back()
    station.wait(QUIET_S)
    trail = station.trail()
    assert ends_s(station, trail) == pytest.approx(INSIDE_S + OUT_OF_REACH_S, abs=1.0)
    for then_s in (10.0, 200.0, 290.0):
        assert station.apart_m(in_time, then_s) < 0.05


@pytest.mark.slow
def test_late_positions_of_a_tracking_agent_are_in_the_smoothed_trail(
    tmp_path: Path, in_time: Station
) -> None:
    """The unit itself had contact all the time."""
    station = Station(tmp_path, out_of_reach=AGENT, script=TrackedByAgent())
    assert ends_s(station, station.trail()) == pytest.approx(INSIDE_S, abs=1.0)
    station.script.now_s += 60.0
    station.script.out_of_reach.clear()
    station.script.status(AGENT)
    station.script.fetch(AGENT)
    station.wait(QUIET_S)
    for then_s in (10.0, 200.0, 290.0):
        assert station.apart_m(in_time, then_s) < 0.05
    station.store.close()


@pytest.mark.slow
def test_unit_never_received_while_it_was_open_has_a_trail(
    tmp_path: Path, in_time: Station
) -> None:
    """A radio that failed from the beginning, and a wearer who was placed by a person."""
    station = Station(tmp_path, never_received="FF-02")
    station.script.now_s += 60.0
    station.script.out_of_reach.clear()
    for _ in range(5):
        station.script.now_s += 1.0
        station.script.status("FF-02")
    station.script.fetch("FF-02")
    station.wait(QUIET_S)
    trail = station.trail("FF-02")
    assert (trail[0].t_ns - station.begin_ns) / 1e9 < 2.0
    assert ends_s(station, trail) == pytest.approx(INSIDE_S + OUT_OF_REACH_S, abs=1.0)
    for then_s in (10.0, 100.0, 290.0):
        assert station.apart_m(in_time, then_s, "FF-02") < 0.05
    station.store.close()


@pytest.mark.slow
def test_kept_result_serves_while_a_journal_is_read_and_is_redone_afterwards(
    station: Station,
) -> None:
    station.catch_up()
    first = station.post_processor.smoothed(station.incident)
    assert station.post_processor.is_newest(station.incident)
    station.back()
    station.wait(0.0)
    station.catch_up()
    assert not station.post_processor.is_newest(station.incident)
    assert station.post_processor.smoothed(station.incident).tracks == first.tracks
    station.wait(QUIET_S)
    station.catch_up()
    assert station.post_processor.is_newest(station.incident)
    made = station.kept.of("i1")
    assert made is not None
    assert ends_s(station, made[2]["FF-01"]) > INSIDE_S + OUT_OF_REACH_S - 5.0
    assert station.kept.report("i1") is not None
    assert made[1] == station.post_processor.smoothed(station.incident).made_ns, "once"


@pytest.mark.slow
def test_backfilled_messages_of_the_time_since_redo_nothing(station: Station) -> None:
    station.catch_up()
    station.script.out_of_reach = {"FF-02"}
    station.go(30)
    station.script.out_of_reach.clear()
    station.script.status("FF-02")
    station.script.fetch("FF-02")
    station.wait(QUIET_S)
    assert station.incident.late_data_ns == 0


@pytest.mark.slow
def test_pins_of_a_debriefing_are_in_it(station: Station) -> None:
    station.catch_up()
    before_m = station.off_m(145.0, "FF-02")
    station.wait(600.0)
    station.script.act(station.pin(145.0, "FF-02"))
    station.wait(QUIET_S)
    after_m = station.off_m(145.0, "FF-02")
    assert after_m < 0.5 * before_m
    report = station.post_processor.assess(
        station.incident, station.records.tracks_of(station.incident)
    )
    assert [one.pin_id for one in report.units[1].pin_residuals] == ["p1"]
    station.script.act(RemovePin("p1"))
    station.wait(QUIET_S)
    assert station.off_m(145.0, "FF-02") == pytest.approx(before_m)


@pytest.mark.slow
def test_starts_and_beacons_of_the_next_incident_are_not_in_it(station: Station) -> None:
    """Starts of people, and the present places of beacons."""
    trail = station.trail("FF-02")
    pose = 50.0, 60.0, 0.5, None, None, 0.0, ""
    station.wait(10.0)
    station.script.act(StartTogether("s", ("FF-01", "FF-02"), 0, *pose))
    station.wait(10.0)
    station.script.act(SetPin("p2", "FF-02", station.script.t_ns, *pose))
    station.script.act(PlaceBeacon("b1", "", 50.0, 60.0, None, 0.5, 3.0))
    station.script.act(SetStart("FF-02", 50.0, 60.0, 0.0, 0.0, 0.5, 0.1))
    station.wait(10.0)
    station.script.act(OpenIncident("i2", "Station Road"))
    assert station.incident.late_data_ns == 0
    assert station.trail("FF-02") == trail
    pins = station.script.pipeline.state.site.pins
    assert set(pins) == {"s:FF-01", "s:FF-02", "p2"}


@pytest.mark.slow
def test_pin_of_the_past_is_none_of_the_next_incident(station: Station) -> None:
    station.script.act(station.pin(145.0, "FF-02"))
    station.wait(10.0)
    station.script.act(OpenIncident("i2", "Station Road"))
    assert not station.script.pipeline.state.site.pins
    refused = station.script.act(station.pin(145.0, "FF-02", "p2"))
    assert not any(isinstance(one, ClosedIncidentChanged) for one in refused)
    station.wait(QUIET_S)
    assert station.off_m(145.0, "FF-02") < 1.0


@pytest.mark.slow
def test_place_of_a_beacon_may_be_set_afterwards(station: Station) -> None:
    """It was passed out of range, and had no place."""
    station.wait(60.0)
    station.back()
    seen = station.script.header("FF-01", captured_s=200.0)
    key = backfilled_key("FF-01", SIGHTING.suffix)
    sighting = Sighting(seen, SightingKind.BEACON, "b1")
    station.script.record(key, encode(sighting))
    station.wait(QUIET_S)
    before_m = station.off_m(200.0)
    north_m, east_m = truth(200.0)
    station.script.act(PlaceBeacon("b1", "", north_m, east_m, None, 0.3, 1.0))
    station.wait(QUIET_S)
    assert station.off_m(200.0) < 0.5 * before_m


def test_sighting_of_the_incident_before_is_no_pin_of_this_one(station: Station) -> None:
    station.wait(60.0)
    station.script.act(OpenIncident("i2", "Station Road"))
    station.back()
    seen = station.script.header("FF-01", captured_s=200.0)
    sighting = Sighting(seen, SightingKind.BEACON, "b1")
    station.script.record(backfilled_key("FF-01", SIGHTING.suffix), encode(sighting))
    state = station.script.pipeline.state
    assert not state.site.pins
    assert state.units["FF-01"].rejected_counts["a sighting of before this incident"] == 1
