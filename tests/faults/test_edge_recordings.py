"""Recordings with faults of real sensors pass a whole agent: flagged, never fatal."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import numpy as np
import pytest

from edge.app.composition import compose_agent
from edge.config import EdgeConfig
from edge.sources.registry import open_source
from edge.storage.data_folder import UnitDataFolder
from edge.tracker.interface import Quality, Reason
from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.channels import EVENT, POSITION, STATUS, parse_key
from shared.codec import decode
from shared.messages import EventKind, Position, Status, UnitEvent

COLUMNS = "t_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,gyro_y_radps,gyro_z_radps"
SOURCE = "simulated:straight?seed=2"


def walk() -> np.ndarray:
    """(n, 7) time and inertial samples of a simulated walk."""
    batches = [batch.imu for batch in open_source(SOURCE).batches()]
    return np.hstack(
        [
            np.concatenate([imu.t_ns for imu in batches])[:, None] * 1e-9,
            np.concatenate([imu.accel_mps2 for imu in batches]),
            np.concatenate([imu.gyro_radps for imu in batches]),
        ]
    )


class UnusedStationLink:
    def open_bus(self) -> Bus:
        return MemoryRouter().attach_unit()

    def is_reachable(self, timeout_s: float) -> bool:
        return True

    def link_failure_reason(self) -> str:
        return "nobody is there"


def run_agent_on(rows: np.ndarray, folder: Path):
    """Messages of an agent that plays these rows: positions, statuses, events."""
    recording = folder / "walk"
    recording.mkdir()
    (recording / "trial.json").write_text('{"rate_hz": 200.0, "gyro_full_scale_dps": 2000.0}')
    np.savetxt(
        recording / "imu.csv.gz", rows, delimiter=",", header=COLUMNS, comments="", fmt="%.9f"
    )
    config = EdgeConfig(unit="u1", source=f"recording:{recording}", data=folder)
    data = UnitDataFolder(folder / "u1")
    source = open_source(config.source)
    agent = compose_agent(config, "u1", data, source, UnusedStationLink(), speed=None)
    journal = agent._parts.journal
    read = journal.close
    sent: list[tuple[str, bytes]] = []

    def keep_and_close() -> None:
        sent.extend(
            (entry.suffix, entry.payload) for entry in journal.read(journal.boot_id, 1, 10**9)
        )
        read()

    journal.close = keep_and_close  # type: ignore[method-assign]
    agent.run(Event())
    data.close()
    decoded = [
        decode(parse_key(f"muster/v1/u1/{suffix}")[1], payload)
        for suffix, payload in sent
        if suffix in (POSITION.suffix, STATUS.suffix, EVENT.suffix)
    ]
    assert [message.header.seq for message in decoded] == sorted(
        {message.header.seq for message in decoded}
    )
    return decoded


def of(messages, kind):
    return [message for message in messages if isinstance(message, kind)]


def reasons(messages) -> Reason:
    union = Reason.NONE
    for position in of(messages, Position):
        union |= position.reasons
    return union


def missing(rows):
    rows[800:810, 1:] = np.nan


def long_missing(rows):
    rows[800:1100, 1:] = np.nan


def repeated(rows):
    rows[800:830:3, 0] = rows[799:829:3, 0]


def backward(rows):
    rows[800:805, 0] -= 0.5


def saturated(rows):
    rows[800:808, 4:] = np.radians(2000.0)


FAULTS = [
    (missing, Reason.BAD_SAMPLES),
    (long_missing, Reason.BAD_SAMPLES),
    (repeated, Reason.NONE),  # the tracker knows when they must have been taken
    (backward, Reason.BAD_SAMPLES),
    (saturated, Reason.GYRO_SATURATED),
]


@pytest.mark.parametrize(("spoil", "reason"), FAULTS)
def test_agent_continues_to_the_end_and_reports_faults(spoil, reason, tmp_path):
    rows = walk()
    spoil(rows)
    messages = run_agent_on(rows, tmp_path)
    positions = of(messages, Position)
    assert positions[-1].header.t_mono_ns - positions[0].header.t_mono_ns > 0.9e9 * rows[-1, 0]
    assert of(messages, UnitEvent)[-1].kind is EventKind.STOPPED
    assert reason in reasons(messages)
    assert all(abs(position.north_m) < 1000.0 for position in positions)


def test_a_gap_is_flagged_and_reported(tmp_path):
    rows = np.delete(walk(), slice(800, 1100), axis=0)
    messages = run_agent_on(rows, tmp_path)
    faults = [event for event in of(messages, UnitEvent) if event.kind is EventKind.SENSOR_FAULT]
    assert len(faults) == 1
    assert "no inertial sample for" in faults[0].detail
    assert reasons(messages) & Reason.SAMPLE_GAP
    assert any(position.quality is not Quality.GOOD for position in of(messages, Position))


def test_a_clean_walk_has_no_faults(tmp_path):
    messages = run_agent_on(walk(), tmp_path)
    kinds = {event.kind for event in of(messages, UnitEvent)}
    assert kinds == {EventKind.STARTED, EventKind.SOURCE_ENDED, EventKind.STOPPED}
    assert not reasons(messages) & (Reason.BAD_SAMPLES | Reason.SAMPLE_GAP)
    assert of(messages, Status)[-1].tracker_rows_dropped == 0
