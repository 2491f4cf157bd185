"""Sound whose place in time can be found again: half a second of a tone at each even second."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from shared.clock import NS_PER_S

PERIOD_S, TONE_S = 2.0, 0.5
_TONE_HZ, _LEVEL = 700.0, 8_000.0

Samples = npt.NDArray[np.int16]


def tone_pattern(began_ns: int, first: int, count: int, rate_hz: int) -> Samples:
    """Samples from number ``first`` on of what began at ``began_ns``, UTC."""
    numbers = np.arange(first, first + count)
    at_s = began_ns % (2 * NS_PER_S) / NS_PER_S + numbers / rate_hz
    tone = np.sin(2.0 * np.pi * _TONE_HZ * numbers / rate_hz) * (at_s % PERIOD_S < TONE_S)
    return np.asarray(_LEVEL * tone, np.int16)


def onsets_s(samples: npt.NDArray[np.float64], rate_hz: int) -> list[float]:
    """Onsets of the tone after silence, from the first sample."""
    width = rate_hz // 100
    power = np.convolve(samples**2, np.ones(width) / width, "same")
    loud = (power > (_LEVEL / 8.0) ** 2).astype(np.int8)
    onsets: list[float] = []
    last_loud = -rate_hz
    for sample in np.flatnonzero(loud):
        if sample - last_loud > rate_hz // 2:
            onsets.append(float(sample) / rate_hz)
        last_loud = int(sample)
    return onsets
