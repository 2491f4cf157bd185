"""Presence of a unit's inertial sensors, on a common clock.  It is computed from the samples' times
and the order of arrival alone, so that a replay gives the same.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from statistics import median

from edge.clocks.timeline import Timeline
from edge.samples import SensorBatch
from shared.clock import NS_PER_S
from shared.coded_text import Term, coded

GONE_NS = 2 * NS_PER_S  # without a sample, while others give some
_APART_NS = NS_PER_S  # by which samples that come together differ in time, on one clock
_TOGETHER_BATCHES = 10  # a sensor without a sample in these may be gone
_BATCHES_TO_TELL = 10  # in a row
_SPREAD_NS = 3 * NS_PER_S // 10  # of these


@dataclass(slots=True)
class _Sensor:
    newest_ns: int | None = None  # on the common clock
    newest_number: int = 0  # of the batch that had it, among those of all
    offset_ns: int = 0  # of the common clock from its own
    is_gone: bool = False
    apart_ns: deque[int] = field(default_factory=lambda: deque(maxlen=_BATCHES_TO_TELL))


class SensorPresence:
    """State of the sensors of one unit; ``take`` each batch once, in the order in which they come.

    The common clock is mostly that of the first sensor with samples.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self._sensors = {name: _Sensor() for name in names}
        self._began_ns: int | None = None  # of the first sample, on the common clock
        self._batches = 0

    @property
    def present(self) -> tuple[str, ...]:
        """Names of the sensors that are not gone, the first one first."""
        return tuple(name for name, sensor in self._sensors.items() if not sensor.is_gone)

    @property
    def leading(self) -> str:
        """Name of the sensor that gives the unit's motion and time."""
        return next(iter(self.present or self._sensors))

    def take(
        self, batch: SensorBatch, timeline: Timeline
    ) -> tuple[SensorBatch, Timeline, tuple[str, ...]]:
        """Return batch and timeline on the common clock, and new findings as sentences for a
        person.

        Samples on a clock that is not known yet are left out.
        """
        sensor = self._sensors.get(batch.sensor)
        if sensor is None or not len(batch.imu):
            return batch, timeline, ()
        self._batches += 1
        news = self._compare_clocks(batch, sensor)
        if sensor.apart_ns:  # its clock is not known yet
            return replace(batch, imu=batch.imu.part(slice(0))), timeline, tuple(news)
        if sensor.offset_ns:
            batch, timeline = _moved(batch, timeline, sensor.offset_ns)
        newest_ns = int(batch.imu.t_ns[-1])
        if self._began_ns is None:
            self._began_ns = newest_ns
        sensor.newest_ns, sensor.newest_number = newest_ns, self._batches
        if sensor.is_gone:
            sensor.is_gone = False
            news.append(coded("sensor-back", "{sensor} is back", sensor=batch.sensor))
        news += self._find_gone(newest_ns)
        return batch, timeline, tuple(news)

    def _compare_clocks(self, batch: SensorBatch, sensor: _Sensor) -> list[str]:
        """Set the sensor's clock offset, where its samples arrive together with much older or newer
        ones of the other sensors.
        """
        times_ns = [
            other.newest_ns
            for other in self._sensors.values()
            if other is not sensor
            and other.newest_ns is not None
            and self._batches - other.newest_number <= _TOGETHER_BATCHES
        ]
        if not times_ns:
            return []
        apart_ns = max(times_ns) - (int(batch.imu.t_ns[-1]) + sensor.offset_ns)
        if abs(apart_ns) < _APART_NS:
            sensor.apart_ns.clear()
            return []
        sensor.apart_ns.append(apart_ns)
        spread_ns = max(sensor.apart_ns) - min(sensor.apart_ns)
        if len(sensor.apart_ns) < _BATCHES_TO_TELL or spread_ns > _SPREAD_NS:
            return []  # while a backlog is caught up, the offset changes with each batch
        sensor.offset_ns += round(median(sensor.apart_ns))
        sensor.apart_ns.clear()
        side = "behind" if sensor.offset_ns > 0 else "ahead"
        return [
            coded(
                "sensor-clock",
                "the clock of {sensor} is {off_s:.1f} s {side} of {others}: it is laid on theirs "
                "by when its samples come",
                sensor=batch.sensor,
                off_s=abs(sensor.offset_ns) / NS_PER_S,
                side=Term(side, side),
                others=" and ".join(self._names(besides=sensor)),
            )
        ]

    def _find_gone(self, now_ns: int) -> list[str]:
        assert self._began_ns is not None
        news: list[str] = []
        for name, sensor in self._sensors.items():
            newest_ns = self._began_ns if sensor.newest_ns is None else sensor.newest_ns
            if not sensor.is_gone and now_ns - newest_ns > GONE_NS:
                sensor.is_gone = True
                news.append(
                    coded(
                        "sensor-gone",
                        "{sensor} has given no samples for {silent_s:.0f} s; {present} goes on",
                        sensor=name,
                        silent_s=GONE_NS / NS_PER_S,
                        present=" and ".join(self.present),
                    )
                )
        return news

    def _names(self, besides: _Sensor) -> list[str]:
        return [
            name
            for name, sensor in self._sensors.items()
            if sensor is not besides and not sensor.is_gone
        ]


def _moved(batch: SensorBatch, timeline: Timeline, offset_ns: int) -> tuple[SensorBatch, Timeline]:
    """Return batch and timeline by a clock that is ``offset_ns`` ahead."""
    imu = replace(batch.imu, t_ns=batch.imu.t_ns + offset_ns)
    others = tuple(replace(one, t_ns=one.t_ns + offset_ns) for one in batch.others)
    moved = replace(timeline, source_origin_ns=timeline.source_origin_ns + offset_ns)
    return replace(batch, imu=imu, others=others), moved
