"""Command ``muster track``: a recording in, a track and the events of its gait as CSV out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.console import Console
from rich.progress import track as progress_bar

from edge.activity.gait_events import GaitEvents, find_gait_events
from edge.sources.black_box import BlackBoxSource
from edge.sources.interface import Source, sensors_in
from edge.sources.recording import RecordingSource
from edge.tracker.choice.selection import select_named
from edge.tracker.interface import FOOT, BodyDimensions, Quality, Reason, TrackBatch
from edge.tracker.registry import TRACKERS, find_tracker
from edge.tracker.track_rows import join_rows
from shared.errors import ConfigError, RecordingError
from shared.mcap_log import segment_paths
from shared.out_file import whole, writable
from shared.quality import in_words

COLUMNS = "t_s,north_m,east_m,down_m,std_north_m,std_east_m,std_down_m,std_heading_rad,quality"
GAIT_COLUMNS = "toe_off_s,initial_contact_s,swing_s,stance_s"
_LONGEST_STANCE_S = 2.0  # of a walk; after a longer one it begins anew


def track(
    recording: Annotated[
        Path,
        typer.Argument(
            help="A trial folder, a CSV of samples, or a black box: a boot or a segment."
        ),
    ],
    out: Annotated[Path, typer.Option(help="The CSV file to write.", callback=writable)],
    tracker: Annotated[
        str, typer.Option(help="One of: " + ", ".join(entry.name for entry in TRACKERS) + ".")
    ] = TRACKERS[0].name,
    gait: Annotated[
        Path | None,
        typer.Option(
            help="A second CSV file: toe-off, initial contact, swing and stance of each stride of "
            "a sensor on a foot.",
            callback=writable,
        ),
    ] = None,
) -> None:
    """Track a recorded walk and write time, position and standard deviations."""
    if gait is not None and FOOT not in find_tracker(tracker).worn_on:
        raise ConfigError(f"--gait needs a sensor on a foot; the tracker '{tracker}' is for others")
    source = BlackBoxSource(recording) if _is_black_box(recording) else RecordingSource(recording)
    rows = run_tracker(source, tracker, quiet=False)
    if not len(rows):
        raise RecordingError(f"{recording} holds no inertial samples: there is nothing to track")
    write_csv(rows, out)
    if gait is not None:
        write_gait(find_gait_events(rows), gait)
    step_m = rows.position_n_m[-1] - rows.position_n_m[0]
    Console(stderr=True).print(
        f"{_report(source)}{len(rows)} rows to {out}: {rows.distance_m[-1]:.1f} m in "
        f"{rows.steps[-1]} strides, ends {np.hypot(step_m[0], step_m[1]):.2f} m from its start "
        f"and {-step_m[2]:+.2f} m higher. {_quality_summary(rows)}."
    )


def _is_black_box(path: Path) -> bool:
    """Return True for a segment, a boot, or several boots, of which one is to be chosen."""
    folders = (path, *path.glob("*/")) if path.is_dir() else ()
    return path.suffix == ".mcap" or any(map(segment_paths, folders))


def _report(source: Source) -> str:
    return f"{source.report}\n" if isinstance(source, RecordingSource) else ""


def _quality_summary(rows: TrackBatch) -> str:
    not_good = rows.quality != Quality.GOOD
    parts = {reason: float(np.mean(not_good & (rows.reasons & reason > 0))) for reason in Reason}
    worst = sorted(filter(parts.get, parts), key=parts.__getitem__, reverse=True)
    why = ", ".join(f"{in_words(reason)} ({parts[reason]:.0%})" for reason in worst)
    return f"{np.mean(not_good):.0%} of the rows are not good" + (f": {why}" if why else "")


def run_tracker(source: Source, name: str, *, quiet: bool) -> TrackBatch:
    """Push a whole recording through a new tracker, as its batches come."""
    sensors = sensors_in(source)
    tracker = select_named(name, sensors, BodyDimensions()).make(sensors, BodyDimensions())
    batches = progress_bar(
        list(source.batches()),
        description="Tracking",
        console=Console(stderr=True),
        transient=True,
        disable=quiet,
    )
    released = [tracker.push(batch.sensor, batch.imu) for batch in batches]
    return join_rows([*released, tracker.finish()])


def write_csv(rows: TrackBatch, out: Path) -> None:
    """Write one line a row; ``COLUMNS`` is the first line."""
    std_m = np.sqrt(np.diagonal(rows.position_cov_m2, axis1=1, axis2=2))
    table = np.column_stack(
        (rows.t_ns * 1e-9, rows.position_n_m, std_m, rows.heading_std_rad, rows.quality)
    )
    with whole(out) as making:
        np.savetxt(making, table, "%.6f" + ",%.4f" * 6 + ",%.5f,%d", header=COLUMNS, comments="")


def write_gait(events: GaitEvents, out: Path) -> None:
    """Write one line a swing; its stance is the one that follows, empty at the end of a walk."""
    stance_s = np.append(events.toe_off_s[1:], np.inf) - events.initial_contact_s
    with whole(out) as making, making.open("w", encoding="utf-8") as lines:
        print(GAIT_COLUMNS, file=lines)
        for toe_off_s, contact_s, follows_s in zip(
            events.toe_off_s, events.initial_contact_s, stance_s, strict=True
        ):
            stance = f"{follows_s:.3f}" if follows_s <= _LONGEST_STANCE_S else ""
            swing_s = contact_s - toe_off_s
            print(f"{toe_off_s:.3f},{contact_s:.3f},{swing_s:.3f},{stance}", file=lines)
