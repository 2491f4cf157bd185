"""Stated gain errors of a sensor pass from settings or source into a unit's uncertainty."""

from __future__ import annotations

import math
import secrets
from dataclasses import dataclass
from pathlib import Path
from threading import Event

import pytest

from edge.app.run import run_agent
from edge.config import EdgeConfig
from edge.sources.black_box import BlackBoxSource
from edge.storage.journal.journal import Journal
from edge.tracker.foot.config import EskfConfig
from shared.channels import DESCRIPTION, POSITION, Channel
from shared.codec import decode
from shared.messages import Message, Position, UnitDescription

UNKNOWN_STD = EskfConfig().start.data_sheet_gain_std
SCENARIO = """\
summary = "two sides of a square"
start = [0, 0]

[[legs]]
type = "stand"
duration_s = 3

[[legs]]
type = "walk"
to = [[25, 0], [25, 25]]
"""


@dataclass(frozen=True)
class AgentFiles:
    """Files of an agent after its walk without a station."""

    described: UnitDescription  # as it would have gone over the bus
    last: Position
    black_box: BlackBoxSource

    @property
    def stated_m(self) -> float:
        return math.hypot(self.last.std_north_m, self.last.std_east_m)


def ran(folder: Path, gain_std: float | None) -> AgentFiles:
    folder.mkdir()
    scenario = folder / "square.toml"
    scenario.write_text(SCENARIO)
    config = EdgeConfig(
        source=f"simulated:{scenario}",
        unit="u1",
        connect=("tcp/127.0.0.1:9",),
        data=folder,
        gain_std=gain_std,
    )
    run_agent(config, Event(), for_s=None, paced=False)
    (boot,) = (folder / "u1" / "black_box").iterdir()
    described, last = newest(folder / "u1" / "journal.sqlite", DESCRIPTION, POSITION)
    assert isinstance(described, UnitDescription)
    assert isinstance(last, Position)
    return AgentFiles(described, last, BlackBoxSource(boot))


def newest(path: Path, *channels: Channel) -> list[Message]:
    """The last message of each channel in the journal that an agent left."""
    journal = Journal(path, lambda: secrets.randbits(63), 0, 10**9)
    try:
        (boot,) = journal.boots()
        kept = {one.suffix: one.payload for one in journal.read(boot.boot_id, 1, boot.last_seq)}
        return [decode(each, kept[each.suffix]) for each in channels]
    finally:
        journal.close()


@pytest.fixture(scope="module")
def by_itself(tmp_path_factory) -> AgentFiles:
    return ran(tmp_path_factory.mktemp("gains") / "itself", None)


@pytest.fixture(scope="module")
def set_wide(tmp_path_factory) -> AgentFiles:
    return ran(tmp_path_factory.mktemp("gains") / "wide", UNKNOWN_STD)


def test_simulated_unit_has_the_gains_of_its_sensors(by_itself):
    assert by_itself.described.gain_std == by_itself.black_box.description.gain_std == 0.002


def test_settings_override_the_description_of_the_source(set_wide):
    assert set_wide.described.gain_std == set_wide.black_box.description.gain_std == UNKNOWN_STD


def test_known_gains_reduce_the_uncertainty_of_the_same_path(by_itself, set_wide):
    assert by_itself.stated_m < 0.8 * set_wide.stated_m
    assert by_itself.last.heading_std_rad < set_wide.last.heading_std_rad
    apart_m = math.dist(
        (by_itself.last.north_m, by_itself.last.east_m),
        (set_wide.last.north_m, set_wide.last.east_m),
    )
    assert apart_m < 0.5  # a compass weighs in
