"""An agent outdoors keeps the steps of its wearer, and starts with them the next time."""

from __future__ import annotations

import logging
from pathlib import Path
from threading import Event

import pytest

from edge.app.run import run_agent
from edge.config import EdgeConfig, WearerConfig
from edge.storage.step_scales import StepScales

LEARNT_BEFORE = "of the usual length, as learnt before"


def config(folder: Path, person: str) -> EdgeConfig:
    return EdgeConfig(
        "simulated:track-400m?worn_on=chest&seed=2",
        worn_on="chest",
        unit="u1",
        connect=("tcp/127.0.0.1:1",),  # no station is there
        data=folder,
        wearer=WearerConfig(person=person),
    )


def test_agent_learns_from_its_receiver_for_its_wearer_alone(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO)
    run_agent(config(tmp_path, "Ada"), Event(), for_s=None, paced=False)
    assert LEARNT_BEFORE not in caplog.text
    learnt = StepScales(tmp_path / "u1" / "step_scales.json", "Ada").learnt
    assert 1.04 < learnt["chest"].factor < 1.16, "the steps are longer than people's in the mean"
    run_agent(config(tmp_path, "Ben"), Event(), for_s=0.0, paced=False)
    assert LEARNT_BEFORE not in caplog.text
    run_agent(config(tmp_path, "Ada"), Event(), for_s=0.0, paced=False)
    assert LEARNT_BEFORE in caplog.text
