"""Errors of the program cost one event of the past, as they did live."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from base_station.app.factories import project_whole_log
from base_station.app.pipeline_factory import past_pipeline
from base_station.core.events import Output, Received, StationEvent
from base_station.core.pipeline import StationPipeline
from base_station.replay.playback import Archive, Playback
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from shared.clock import NS_PER_S, ManualClock
from shared.mcap_log import SegmentWriter
from shared.messages import UnitEvent
from tests.rig.logged_walk import archive, walk_with_mayday
from tests.rig.station_script import START_NS


@pytest.fixture
def mistaken(monkeypatch: pytest.MonkeyPatch) -> None:
    """The program with an error in its handling of units' descriptions."""
    walk_with_mayday()  # which the tests replay: made by a program without the error
    right = StationPipeline.step

    def step(self: StationPipeline, event: StationEvent) -> list[Output]:
        if isinstance(event, Received) and isinstance(event.message, UnitEvent):
            raise ZeroDivisionError("a mistake")
        return right(self, event)

    monkeypatch.setattr(StationPipeline, "step", step)


@pytest.mark.usefixtures("mistaken")
def test_program_error_costs_one_event_of_the_past_as_it_did_live(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    source = archive(walk_with_mayday(), tmp_path)
    playback = Playback(Archive(source.open_log, source.checkpoints, past_pipeline))
    for _ in playback.seek(START_NS + 100 * NS_PER_S):
        pass
    state = playback.pipeline.state
    assert state.t_ns == START_NS + 100 * NS_PER_S
    assert state.alarms == {}
    assert "a mistake" in caplog.text


@pytest.mark.slow
@pytest.mark.usefixtures("mistaken")
def test_database_is_rebuilt_from_a_log_with_a_program_error(tmp_path: Path) -> None:
    """A station whose database is lost rebuilds it before it starts."""
    with closing(SegmentWriter(tmp_path / "log")) as log:
        for record in walk_with_mayday():
            log.write(*record)
    with Store(tmp_path / "station.sqlite") as store:
        count = project_whole_log(store, tmp_path / "log", lambda _: None)
        incident = Records(store, ManualClock()).require_incident("i1")
        tracks = Records(store, ManualClock()).tracks_of(incident)
    assert count == len(walk_with_mayday())
    assert tracks["FF-01"][-1].t_ns > START_NS + 100 * NS_PER_S
