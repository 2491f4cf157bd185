"""``muster bench published``: positions that units would publish on simulated walks, and the truth.

``muster bench fusion --tracked`` has its people walk by it: base station and edge meet only in
what is published.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.console import Console
from rich.progress import track as progress_bar

from edge.agent.position_publisher import PositionPublisher
from edge.clocks.timeline import Timeline
from edge.simulation.scenario import read_scenario
from edge.simulation.simulation import CONSUMER_SENSORS, UNCALIBRATED_SENSORS, Simulation
from edge.tracker.registry import TRACKERS, make_tracker
from shared.clock import NS_PER_S, SystemClock
from shared.errors import UserError
from shared.header_factory import HeaderFactory
from shared.published_walk import PublishedWalk, write_walk


def bench_published(
    scenarios: Annotated[list[Path], typer.Argument(help="TOML files, each of one walk.")],
    out: Annotated[
        Path, typer.Option(help="A folder: for each scenario a CSV of its name is written there.")
    ],
    seed: Annotated[int, typer.Option(help="Seed of the first scenario.")] = 0,
    rate_hz: Annotated[float, typer.Option(min=0.1, max=50.0, help="Rate of positions.")] = 2.0,
    *,
    uncalibrated: Annotated[
        bool, typer.Option("--uncalibrated", help="Sensors as a data sheet has them.")
    ] = False,
) -> None:
    """Write the positions that units would publish on simulated walks, and the true ones."""
    if not out.is_dir():
        raise UserError(f"{out} is no folder; make it, or give another one")
    sensors = UNCALIBRATED_SENSORS if uncalibrated else CONSUMER_SENSORS
    console = Console(stderr=True)
    for number, path in enumerate(progress_bar(scenarios, "Walking", console=console)):
        simulation = Simulation(read_scenario(path), seed + number, sensors)
        write_walk(out / f"{path.stem}.csv", published(simulation, rate_hz))


def published(simulation: Simulation, rate_hz: float) -> PublishedWalk:
    """By the default tracker."""
    tracker = make_tracker(TRACKERS[0].name, simulation.description)
    stream, timeline = PositionPublisher(HeaderFactory("", 1, SystemClock()), rate_hz), Timeline()
    positions = []
    for batch in simulation.batches():
        positions += stream.push(tracker.push(batch.imu), timeline)
    positions += stream.push(tracker.finish(), timeline)
    t_ns = np.array([position.header.t_mono_ns for position in positions])
    t_s = np.asarray((t_ns - t_ns[0]) / NS_PER_S, np.float64)
    return PublishedWalk(t_s, simulation.truth(t_s).position_n_m, positions)
