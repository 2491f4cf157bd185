"""A black box is tracked again with the steps that its unit has learnt of the wearer."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import pytest
from typer.testing import CliRunner, Result

from edge.app.run import run_agent
from edge.cli import app
from edge.config import EdgeConfig, WearerConfig
from edge.storage.step_scales import StepScales
from edge.tracker.interface import StepScale
from shared.channels import POSITION, parse_key
from shared.codec import decode
from shared.mcap_log import read_log
from shared.messages import Position

FACTOR = 1.08


@pytest.fixture(scope="module")
def boot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recording of a walk of which nothing was known; the steps were learnt after it."""
    data = tmp_path_factory.mktemp("units")
    config = EdgeConfig(
        "simulated:straight?seed=3",
        worn_on="chest",
        unit="u1",
        connect=("tcp/127.0.0.1:1",),  # no station is there
        data=data,
        wearer=WearerConfig(person="Ada"),
    )
    run_agent(config, Event(), for_s=None, paced=False)
    StepScales(data / "u1" / "step_scales.json", "Ada").save({"chest": StepScale(FACTOR, 0.03)})
    (recording,) = (data / "u1" / "black_box").iterdir()
    return recording


def retracked(boot: Path, out: Path, *options: str) -> Result:
    return CliRunner().invoke(app, ["retrack", str(boot), "--out", str(out), *options])


def walked_m(log: Path) -> float:
    """Way of the last position."""
    found = []
    for _, key, payload in read_log(log):
        _, channel = parse_key(key)
        if channel is POSITION:
            found.append(decode(channel, payload))
    last = found[-1]
    assert isinstance(last, Position)
    return last.distance_m


def test_the_way_is_longer_by_as_much_as_the_persons_steps(boot: Path, tmp_path: Path) -> None:
    mean = retracked(boot, tmp_path / "mean")
    assert mean.exit_code == 0
    assert mean.stderr == (
        "steps of people in the mean, sensor at chest; --person takes what the unit has learnt of "
        "its wearer's\n"
    )
    own = retracked(boot, tmp_path / "own", "--person", "Ada")
    assert own.exit_code == 0
    assert "steps of Ada, sensor at chest: 1.080 of the usual length" in own.stderr
    assert own.stdout == mean.stdout, "the times reached, for a program"
    ratio = walked_m(tmp_path / "own") / walked_m(tmp_path / "mean")
    assert ratio == pytest.approx(FACTOR, rel=0.005)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--person", "Ben"), "nothing on the steps of 'Ben'"),
        (("--set", "wearer.person=Ada"), "has --person"),
        (("--set", "wearer={person='Ada'}"), "has --person"),
    ],
)
def test_a_person_that_cannot_be_leaves_nothing(
    boot: Path, tmp_path: Path, options: tuple[str, ...], message: str
) -> None:
    refused = retracked(boot, tmp_path / "out", *options)
    assert refused.exit_code != 0
    assert message in str(refused.exception)
    assert list(tmp_path.iterdir()) == []


def test_tracker_that_counts_no_steps_is_reported(boot: Path, tmp_path: Path) -> None:
    done = retracked(boot, tmp_path / "out", "--person", "Ada", "--tracker", "eskf")
    assert done.stderr.endswith("tracker eskf takes no path from lengths of steps\n")
