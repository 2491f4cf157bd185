"""Samples of one IIO device that were read at once, and the reader that gives them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from edge.samples import Floats, Nanoseconds


def _no_times() -> Nanoseconds:
    return np.empty(0, np.int64)


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Samples in time order, on this machine's monotonic clock."""

    t_ns: Nanoseconds = field(default_factory=_no_times)
    values: dict[str, Floats] = field(default_factory=dict)  # (n, 3) of a kind of channel
    temperature_degc: Floats | None = None  # (n,); None: the device has none, or it was not read

    def __len__(self) -> int:
        return len(self.t_ns)

    def without(self, kind: str) -> Block:
        rest = {one: values for one, values in self.values.items() if one != kind}
        return Block(self.t_ns, rest, self.temperature_degc)

    def part(self, rows: NDArray[np.bool_]) -> Block:
        degc = self.temperature_degc
        return Block(
            self.t_ns[rows],
            {kind: values[rows] for kind, values in self.values.items()},
            None if degc is None else degc[rows],
        )


class DeviceReader(Protocol):
    """Reader of a device that is open.  Failures are OSErrors, or UnusableDeviceErrors."""

    @property
    def descriptor(self) -> int | None:
        """File that becomes readable when there are samples; None: it is read when it is due."""
        ...

    @property
    def rate_hz(self) -> float: ...

    def wait_s(self, now_ns: int) -> float:
        """Return how long it may be left alone, at most."""
        ...

    def take(self) -> Block:
        """Return what there is; never waits for more."""
        ...

    def take_events(self) -> list[str]:
        """Return what is wrong with its samples since the last call, for a person."""
        ...

    def silence_reason(self) -> str:
        """Return why there may be no samples."""
        ...

    def close(self) -> None: ...
