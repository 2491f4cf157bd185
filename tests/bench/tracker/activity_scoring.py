"""Labels of activities, and their confusion matrix with the unit's classification.

Labels of recordings come from their reference alone.  Where it cannot tell the kinds apart
(between walking and running; on a turn of speed) there is no label and nothing is scored.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from edge.activity.monitor import ActivityMonitor
from edge.samples import Floats, SensorBatch, SensorDescription
from edge.sources.recording import RecordedTruth
from edge.tracker.registry import make_tracker
from shared.clock import NS_PER_S
from shared.messages import Activity

Label = Callable[[float], Activity | None]  # of a time in s since the epoch of the samples

_ASKED_EVERY_NS = NS_PER_S // 4
_SETTLED_S = 2.5  # the unit is told of a stride up to a second after it has ended
_LONGEST_STRIDE_S = 2.5
_WALKING_MPS = (0.2, 1.8)
_RUNNING_MPS = 2.3
_STILL_M = 0.05  # of way in two seconds


@dataclass(slots=True)
class Confusion:
    """Counts of (what was done, what was said), every quarter of a second."""

    counts: dict[tuple[Activity, Activity], int] = field(default_factory=dict)

    def add(self, done: Activity, reported: Activity) -> None:
        self.counts[done, reported] = self.counts.get((done, reported), 0) + 1

    def of(self, done: Activity) -> int:
        return sum(count for (kind, _), count in self.counts.items() if kind is done)

    def recall(self, done: Activity) -> float:
        return self.counts.get((done, done), 0) / self.of(done)

    @property
    def accuracy(self) -> float:
        right = sum(count for (done, reported), count in self.counts.items() if done is reported)
        return right / max(sum(self.counts.values()), 1)


@dataclass(slots=True)
class ActivityScore:
    """``settled`` leaves out the 2.5 s after each change of what is done."""

    every: Confusion = field(default_factory=Confusion)
    settled: Confusion = field(default_factory=Confusion)
    falls_done: int = 0
    falls_reported: int = 0
    duration_s: float = 0.0


def score_activity(
    batches: Iterator[SensorBatch],
    description: SensorDescription,
    label: Label,
    until_s: float,
    score: ActivityScore,
) -> None:
    """Play samples through the default tracker as a unit does, and add to ``score``."""
    tracker = make_tracker("eskf", description)
    monitor = ActivityMonitor()
    asked_ns = begin_ns = t_ns = None
    done, since_s = None, 0.0
    for batch in batches:
        imu = batch.imu
        if not len(imu):
            continue
        t_ns = int(imu.t_ns[-1])
        begin_ns = t_ns if begin_ns is None else begin_ns
        if t_ns - begin_ns > until_s * NS_PER_S:
            break
        score.falls_reported += monitor.push(imu, tracker.push(imu))
        if asked_ns is not None and t_ns - asked_ns < _ASKED_EVERY_NS:
            continue
        asked_ns = t_ns
        now = label(t_ns / NS_PER_S)
        if now is not done:
            done, since_s = now, t_ns / NS_PER_S
            score.falls_done += done is Activity.FALLING
        reported = monitor.activity(t_ns)
        if done is None:
            continue
        score.every.add(done, reported)
        if t_ns / NS_PER_S - since_s >= _SETTLED_S:
            score.settled.add(done, reported)
    if begin_ns is not None and t_ns is not None:
        score.duration_s += (t_ns - begin_ns) / NS_PER_S


def recorded_label(truth: RecordedTruth, *, sampled: bool) -> Label:
    """Labels by the speed of the reference; ``sampled``: it follows the foot all the time.

    Otherwise it has one point a stride and only tells how fast the strides were.
    """
    return _sampled_label(truth) if sampled else _stride_label(truth)


def _sampled_label(truth: RecordedTruth) -> Label:
    step_m = np.hypot(*np.diff(truth.position_n_m[:, :2], axis=0).T)
    way_m = np.concatenate(([0.0], np.cumsum(step_m)))

    def label(t_s: float) -> Activity | None:
        if not truth.t_s[0] + 1.0 <= t_s <= truth.t_s[-1] - 1.0:
            return None
        ends_m = np.interp([t_s - 1.0, t_s + 1.0], truth.t_s, way_m)
        gone_m = float(ends_m[1] - ends_m[0])
        return Activity.STILL if gone_m < _STILL_M else _by_speed(gone_m / 2.0)

    return label


def _stride_label(truth: RecordedTruth) -> Label:
    stride_m = np.hypot(*np.diff(truth.position_n_m[:, :2], axis=0).T)
    stride_s: Floats = np.diff(truth.t_s)

    def label(t_s: float) -> Activity | None:
        stride = int(np.searchsorted(truth.t_s, t_s)) - 1
        if not 0 <= stride < len(stride_s) or stride_s[stride] > _LONGEST_STRIDE_S:
            return None
        return _by_speed(float(stride_m[stride] / stride_s[stride]))

    return label


def _by_speed(speed_mps: float) -> Activity | None:
    slow_mps, fast_mps = _WALKING_MPS
    if slow_mps <= speed_mps <= fast_mps:
        return Activity.WALKING
    return Activity.RUNNING if speed_mps >= _RUNNING_MPS else None


def kinds_in(confusions: Sequence[Confusion]) -> list[Activity]:
    """Every activity done or said, in the order of their numbers."""
    return sorted({kind for confusion in confusions for pair in confusion.counts for kind in pair})
