"""Header of each message that a program sends: sender, boot, sequence number and times."""

from __future__ import annotations

from collections.abc import Callable

from shared.clock import Clock
from shared.messages import Header


class HeaderFactory:
    """Gives out headers with consecutive sequence numbers for one sender and one boot."""

    def __init__(
        self, unit_id: str, boot_id: int, clock: Clock, utc_std_s: Callable[[], float] = lambda: 0.0
    ) -> None:
        """``utc_std_s``: standard error of ``clock`` against UTC now; 0: unknown."""
        self._unit_id = unit_id
        self._boot_id = boot_id
        self._clock = clock
        self._utc_std_s = utc_std_s
        self._seq = 0

    @property
    def unit_id(self) -> str:
        return self._unit_id

    @property
    def boot_id(self) -> int:
        return self._boot_id

    @property
    def last_seq(self) -> int:
        """0 before the first header."""
        return self._seq

    def utc_ns(self, t_mono_ns: int) -> int:
        """The sender's estimate of UTC at its monotonic ``t_mono_ns``."""
        return self._clock.utc_ns() - (self._clock.monotonic_ns() - t_mono_ns)

    def header(self, t_mono_ns: int | None = None) -> Header:
        """The next header, for something captured at ``t_mono_ns`` (now when left out)."""
        captured_ns = self._clock.monotonic_ns() if t_mono_ns is None else t_mono_ns
        self._seq += 1
        return Header(
            unit_id=self._unit_id,
            boot_id=self._boot_id,
            seq=self._seq,
            t_mono_ns=captured_ns,
            t_utc_ns=self.utc_ns(captured_ns),
            utc_std_s=self._utc_std_s(),
        )
