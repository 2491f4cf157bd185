"""Polling of a device that has no buffer, or no trigger: its raw values are read again and again.

Its axes are read one after the other, and a sample has the time in the middle: this suits a sensor
that is worn still, and less a foot.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from edge.sources.iio.attributes import read_number, read_scaled
from edge.sources.iio.block import Block
from edge.sources.iio.conversion import TEMPERATURE, axes_of, read_conversion
from edge.sources.iio.plan import CapturePlan
from edge.sources.iio.stream_monitor import StreamMonitor
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded

POLLING_RATE_HZ = 100.0
_TEMPERATURE_NS = NS_PER_S
_DEGC = 1e-3  # of the unit of temperatures


class PollingReader:
    """Reader that gives a sample whenever one is due; one that it is too late for is left out."""

    descriptor = None

    def __init__(
        self, device: Path, kinds: tuple[str, ...], plan: CapturePlan, clock: Clock
    ) -> None:
        """Raises OSError and UnusableDeviceError."""
        self._device = device
        self._clock = clock
        self.rate_hz = plan.rate_hz
        self._period_ns = round(NS_PER_S / plan.rate_hz)
        plan.carry_out()
        self._conversions = {kind: read_conversion(device, kind) for kind in kinds}
        self._monitor = StreamMonitor(plan.rate_hz)
        self._due_ns = self._temperature_due_ns = clock.monotonic_ns()
        self._has_temperature = any(
            (device / f"{TEMPERATURE}_{attribute}").exists() for attribute in ("raw", "input")
        )

    def wait_s(self, now_ns: int) -> float:
        return max(0.0, (self._due_ns - now_ns) / NS_PER_S)

    def take(self) -> Block:
        begun_ns = self._clock.monotonic_ns()
        if begun_ns < self._due_ns:
            return Block()
        values = {
            kind: conversion.apply(
                np.array([[read_number(self._device / f"{axis}_raw") for axis in axes_of(kind)]])
            )
            for kind, conversion in self._conversions.items()
        }
        ended_ns = self._clock.monotonic_ns()
        self._due_ns = max(self._due_ns + self._period_ns, ended_ns)
        times_ns = np.array([(begun_ns + ended_ns) // 2], np.int64)
        self._monitor.count(times_ns, 0)
        return Block(times_ns, values, self._read_temperature(ended_ns))

    def take_events(self) -> list[str]:
        return self._monitor.take_events()

    def silence_reason(self) -> str:
        return coded("iio-slow", "it takes too long to read")

    def close(self) -> None:
        """Nothing is held open between readings."""

    def _read_temperature(self, now_ns: int) -> np.ndarray[tuple[int], np.dtype[np.float64]] | None:
        if not self._has_temperature:
            return None
        if now_ns < self._temperature_due_ns:
            return np.array([np.nan])
        self._temperature_due_ns = now_ns + _TEMPERATURE_NS
        return np.array([_DEGC * read_scaled(self._device, TEMPERATURE, TEMPERATURE)])
