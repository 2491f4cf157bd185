"""A recording pulled from a running agent, by the command and by the API of a running station."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from typer.testing import CliRunner

from base_station.cli import app
from edge.sources.black_box import BlackBoxSource
from shared.errors import UserError
from shared.mcap_log import segment_paths
from tests.rig.station_command import Agent, Browser, Command
from tests.rig.station_process import free_port
from tests.rig.waiting import until

UNIT = "anna"


class RecordingScene:
    """A station and an agent that records."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self.folder = folder
        self.data = folder / "station"
        self.bus = f"tcp/127.0.0.1:{free_port()}"
        where = ["--data", str(self.data), "--listen", self.bus]
        self.where = where
        http = ["--http", f"127.0.0.1:{free_port()}", "--insecure"]
        station = stack.enter_context(Command(folder / "station.txt", "serve", *where, *http))
        self.browser = stack.enter_context(Browser(station.wait_ready(), self.data))
        self.browser.call("POST", "/units", json={"unit_id": UNIT})
        flags = ["--unit", UNIT, "--source", "simulated:straight", "--connect", self.bus]
        flags += ["--data", str(folder / "units")]
        self.agent = stack.enter_context(Agent(folder / "agent.txt", *flags))
        self.began_ms = round(time.time() * 1000) - 60_000
        until(lambda: "linked to the station" in self.agent.output(), "the unit is linked")
        until(lambda: self._recorded_bytes() > 20_000, "the unit has recorded")

    def fetch(self, *arguments: str) -> tuple[int, str]:
        with Command(
            self.folder / "fetch.txt", "fetch-recording", *arguments, *self.where
        ) as command:
            return command.wait(), command.output()

    def pulled(self) -> list[Path]:
        return [boot for boot in (self.data / "recordings" / UNIT).glob("2*") if boot.is_dir()]

    def _recorded_bytes(self) -> int:
        return sum(one.stat().st_size for one in (self.folder / "units").rglob("*.mcap"))


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RecordingScene]:
    with ExitStack() as stack:
        yield RecordingScene(tmp_path_factory.mktemp("fetch"), stack)


def test_command_pulls_the_recording_of_a_unit(running: RecordingScene) -> None:
    code, reported = running.fetch(UNIT, "--from", "2020-01-01T00:00+00:00")
    assert code == 0, reported
    (boot,) = running.pulled()
    assert boot.name in {one.name for one in (running.folder / "units" / UNIT).glob("*/*")}
    assert segment_paths(boot)
    assert sum(1 for _ in BlackBoxSource(boot).batches()) > 10


def test_transfer_by_the_api_shows_its_progress(running: RecordingScene) -> None:
    form = {"unit_id": UNIT, "from_ms": running.began_ms}
    asked = running.browser.call("POST", "/recordings", json=form)

    def state() -> dict[str, object]:
        (pull,) = (
            one
            for one in running.browser.call("GET", "/recordings")
            if one["fetch_id"] == asked["fetch_id"]
        )
        return dict(pull)

    until(lambda: state()["state"] in ("done", "failed"), "it is over")
    assert (state()["state"], state()["problem"]) == ("done", "")
    assert state()["done_bytes"] == state()["total_bytes"] != 0


@pytest.mark.parametrize(
    ("arguments", "reported"),
    [
        (["bert", "--from", "2020-01-01"], "there is no unit bert; known are: anna"),
        ([UNIT], "say which window"),
        ([UNIT, "--incident", "none"], "there is no incident none"),
        ([UNIT, "--from", "yesterday"], "'yesterday' is no time"),
        ([UNIT, "--from", "2020-01-02", "--to", "2020-01-01"], "ends before it begins"),
        ([UNIT, "--from", "2020-01-01", "--to", "2020-01-02"], "no recording of that time"),
    ],
)
def test_invalid_request_is_refused_with_a_reason(
    running: RecordingScene, arguments: list[str], reported: str
) -> None:
    result = CliRunner().invoke(app, ["fetch-recording", *arguments, *running.where])
    assert isinstance(result.exception, UserError)
    assert reported in str(result.exception)


def test_a_refusal_is_one_sentence_and_no_success(running: RecordingScene) -> None:
    code, text = running.fetch("bert", "--from", "2020-01-01")
    assert code == 2
    assert len(text.strip().splitlines()) == 1
