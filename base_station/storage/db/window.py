"""Windows of time in queries."""

from __future__ import annotations

import msgspec

FOREVER_NS = 2**63 - 1


class Window(msgspec.Struct, frozen=True):
    """From (included) until (left out), station time."""

    from_ns: int
    until_ns: int

    def within(self, other: Window) -> Window:
        return Window(max(self.from_ns, other.from_ns), min(self.until_ns, other.until_ns))


EVER = Window(0, FOREVER_NS)
