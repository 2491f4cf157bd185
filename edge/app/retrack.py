"""Retracking: a black box in, the messages of its unit with other settings out.

The station does with them what it did with those that the unit sent at the time (``muster base
rerun``).  Times in the messages are those of the samples; log time is that of the black box.
"""

from __future__ import annotations

import shutil
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.app.fitted_sensors import fitted_sensors
from edge.app.known_steps import known_steps, steps_used
from edge.app.merged_batches import merged
from edge.app.tracking import Tracking, tracking_of
from edge.config import EdgeConfig
from edge.samples import ButtonPress
from edge.sources.black_box import BlackBoxSource
from shared.channels import NO_TRACKER, channel_of
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.config import load_config, nearest
from shared.errors import ConfigError, RecordingError
from shared.header_factory import HeaderFactory
from shared.mcap_log import SegmentPolicy, SegmentWriter
from shared.messages import Message, Position, Status, UnitDescription

_WRITTEN = Position | Status | UnitDescription
_SETTINGS = (
    "gain_std",
    "gyro_bias_std_radps",
    "mount",
    "place",
    "wearer",
    "worn_on",
)  # that change a path
_PROGRESS_NS = 20 * NS_PER_S  # of the recording


def write_retracked(
    recording: Path,
    out: Path,
    tracker: str,
    calibration: Path | None,
    settings: Iterable[str],
    rate_hz: float,
    on_progress: Callable[[int], None],
    person: str = "",
) -> str:
    """Write the log of what comes out of a black box; return a sentence on the lengths of steps
    that were used.

    ``on_progress`` gets the log time reached.  ``person``: the wearer, with whose steps, as the
    unit has learnt them, the tracker starts; empty: with those of people in the mean.
    Raises ConfigError, RecordingError or LogError; then nothing is left at ``out``.
    """
    source = BlackBoxSource(recording)
    if out.exists():
        raise ConfigError(f"{out} is there already; choose another folder")
    with TemporaryDirectory(prefix="muster-retrack-") as scratch:
        config = config_of(source, recording, tracker, calibration, settings)
        sensors = fitted_sensors(config, source, source.unit_id, Path(scratch))
    known = known_steps(person, _folders_of_unit(recording))
    tracking = tracking_of(config, sensors, known)
    making = out.with_name(f".part-{out.name}")
    shutil.rmtree(making, ignore_errors=True)
    with closing(SegmentWriter(making, SegmentPolicy(segment_s=1e9, flush_every_s=600.0))) as log:
        reported_ns = 0
        for log_ns, message in retracked(source, config, sensors, tracking, rate_hz):
            log.write(log_ns, channel_of(message).key(source.unit_id), encode(message))
            if log_ns - reported_ns >= _PROGRESS_NS:
                reported_ns = log_ns
                on_progress(log_ns)
    making.replace(out)
    return steps_used(tracking.name, tracking.tracker, person, known)


def config_of(
    source: BlackBoxSource,
    recording: Path,
    tracker: str,
    calibration: Path | None,
    settings: Iterable[str],
) -> EdgeConfig:
    """Return the settings of the unit as it recorded, with what is given in place of them.

    Raises ConfigError for a setting or a value that cannot be, RecordingError where a calibration
    that the unit used is not beside the recording.
    """
    flags: dict[str, object] = {
        "source": f"mcap:{recording}",
        "tracker": tracker or source.recorded.tracker,
        **dict(map(_setting, settings)),
    }
    if flags["tracker"] == NO_TRACKER:
        raise ConfigError(f"{source.unit_id} did not track by itself; give the tracker's name")
    if calibration is not None:
        flags["calibration"] = calibration
    else:
        flags.update(_calibrations(source.recorded, recording))
    config = load_config(None, EdgeConfig, flags)
    if config.wearer.person:
        raise ConfigError("wearer.person is no setting here; `muster edge retrack` has --person")
    return config


def retracked(
    source: BlackBoxSource,
    config: EdgeConfig,
    sensors: Sequence[FittedSensor],
    tracking: Tracking,
    rate_hz: float,
) -> Iterator[tuple[int, Message]]:
    """Yield positions, statuses and descriptions with the log times of the samples from which they
    come.
    """
    pipeline: TrackerPipeline | None = None
    log_ns = 0
    batches = source.logged_batches()
    for log_ns, batch in merged(batches) if len(sensors) == 1 else batches:
        if pipeline is None:
            first_ns = int(batch.imu.t_ns[0]) if len(batch.imu) else 0
            pipeline = TrackerPipeline(
                UnitIdentity(
                    "", source.recorded.source, tracking.name, tuple(sensors), config.place
                ),
                tracking.tracker,
                HeaderFactory(
                    source.unit_id, source.recorded.header.boot_id, ManualClock(log_ns - first_ns)
                ),
                rate_hz,
                foot_sensor=tracking.foot_sensor,
                worn_on=tracking.worn_on,
            )
            yield from _written(log_ns, pipeline.start())
        pipeline.take_presses(one for one in batch.others if isinstance(one, ButtonPress))
        yield from _written(log_ns, pipeline.step(batch))
    if pipeline is None:
        raise RecordingError("the recording holds no samples: there is nothing to track")
    yield from _written(log_ns, pipeline.finish())


def _written(log_ns: int, messages: Iterable[Message]) -> Iterator[tuple[int, Message]]:
    return ((log_ns, message) for message in messages if isinstance(message, _WRITTEN))


def _setting(text: str) -> tuple[str, object]:
    """Name and value, as TOML has it; what is no TOML is a text."""
    name, equals, value = (part.strip() for part in text.partition("="))
    if not equals:
        raise ConfigError(f"{text!r} is no setting with its value; write wearer.height_m=1.8")
    if name.partition(".")[0] not in _SETTINGS:
        known = nearest(name, _SETTINGS, _SETTINGS)
        raise ConfigError(f"{name} is no setting of a unit that changes its path; {known}")
    try:
        return name, tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return name, value


def _calibrations(recorded: UnitDescription, recording: Path) -> Mapping[str, Any]:
    """Return the settings that name the calibrations that were in use, by sensor where there are
    several.
    """
    sensors = {one.name: one.calibration for one in recorded.sensors} or {"": recorded.calibration}
    found = {name: _file_of(one, recording) for name, one in sensors.items() if one}
    if not found:
        return {}
    if tuple(sensors) == ("",):
        return {"calibration": found[""]}
    return {"sensors": [{"name": name, "calibration": file} for name, file in found.items()]}


def _file_of(calibration: str, recording: Path) -> Path:
    """Return the file of a calibration by its identity: beside the boots, where a unit and a
    station keep those that were used.
    """
    folders = [folder / "calibrations" for folder in _folders_of_unit(recording)]
    found = next((one for one in folders if (one / f"{calibration}.toml").is_file()), None)
    if found is None:
        raise RecordingError(
            f"the calibration {calibration}, which the unit used, is not beside {recording}; bring "
            "its folder calibrations too, or give a calibration"
        )
    return found / f"{calibration}.toml"


def _folders_of_unit(recording: Path) -> tuple[Path, ...]:
    """Return where other files of a unit are beside the boots that a station has pulled, and where
    the unit itself keeps them.
    """
    boot = recording if recording.is_dir() else recording.parent
    return tuple(boot.absolute().parents[:2])
