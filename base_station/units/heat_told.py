"""Over which times a unit's temperatures are known, and what they add to its thermal dose.

The radio loses stretches of it, and a journal brings them later, in pieces.  What is added for a
silence is then taken back for what was really so, in whatever order that comes.

How many stretches are told apart is bounded.  Beyond that the shortest silence counts as known:
what was taken for it stands, and what a journal brings of it later changes nothing.
"""

from __future__ import annotations

from itertools import pairwise

import msgspec

from base_station.units.thermal import dose_of
from shared.clock import NS_PER_S

LONGEST_STEP_S = 10.0  # of silence that still counts as being as hot as before
JOINED_NS = 3 * NS_PER_S // 2  # nothing is missing between readings so near, one a second
MOST = 500  # stretches


class HeatStretch(msgspec.Struct):
    """Of one run of the unit's program, without a silence; the unit's monotonic time."""

    boot_id: int
    first_ns: int
    first_degc: float
    last_ns: int
    last_degc: float


def follow(told: list[HeatStretch], boot_id: int, t_ns: int, degc: float) -> float:
    """It came live; gives what it adds to the dose."""
    new = HeatStretch(boot_id, t_ns, degc, t_ns, degc)
    last = told[-1] if told else None
    if last is None or last.boot_id != boot_id or t_ns < last.last_ns:  # its clock may be set back
        _append(told, new)
        return 0.0
    added = _between(last, new)
    if t_ns - last.last_ns <= JOINED_NS:
        last.last_ns, last.last_degc = t_ns, degc
    else:
        _append(told, new)
    return added


def fill(told: list[HeatStretch], boot_id: int, t_ns: int, degc: float) -> float:
    """It came late; gives by how much the dose is another."""
    if any(one.boot_id == boot_id and one.first_ns <= t_ns <= one.last_ns for one in told):
        return 0.0
    new = HeatStretch(boot_id, t_ns, degc, t_ns, degc)
    row = _place(told, new)
    before = _of_run(told, row - 1, boot_id)
    after = _of_run(told, row, boot_id)
    added = _between(before, new) + _between(new, after) - _between(before, after)
    told.insert(row, new)
    _join(told, row + 1)
    _join(told, row)
    _bound(told)
    return added


def forget_all_but_last(told: list[HeatStretch]) -> None:
    """What is counted begins anew with the next reading."""
    del told[:-1]
    for last in told:
        last.first_ns, last.first_degc = last.last_ns, last.last_degc


def _place(told: list[HeatStretch], new: HeatStretch) -> int:
    """Before what its run told later, else behind all of that."""
    rows = [row for row, one in enumerate(told) if one.boot_id == new.boot_id]
    later = (row for row in rows if told[row].first_ns > new.last_ns)
    return next(later, rows[-1] + 1 if rows else 0)


def _of_run(told: list[HeatStretch], row: int, boot_id: int) -> HeatStretch | None:
    is_there = 0 <= row < len(told) and told[row].boot_id == boot_id
    return told[row] if is_there else None


def _between(before: HeatStretch | None, after: HeatStretch | None) -> float:
    """Nobody knows of the rest of a silence, but that it was hot before it and after it."""
    if before is None or after is None:
        return 0.0
    elapsed_s = max(after.first_ns - before.last_ns, 0) / NS_PER_S
    told_s = min(elapsed_s, LONGEST_STEP_S)
    cooler_degc = min(before.last_degc, after.first_degc)
    return dose_of(before.last_degc, told_s) + dose_of(cooler_degc, elapsed_s - told_s)


def _join(told: list[HeatStretch], row: int) -> None:
    """With the one before, where nothing is missing between them."""
    if not 0 < row < len(told):
        return
    silent_ns = _silence_ns(told[row - 1], told[row])
    if silent_ns is not None and silent_ns <= JOINED_NS:
        _merge(told, row)


def _append(told: list[HeatStretch], new: HeatStretch) -> None:
    told.append(new)
    _bound(told)


def _bound(told: list[HeatStretch]) -> None:
    """Of runs without a silence between any two stretches the oldest is let go."""
    if len(told) <= MOST:
        return
    silences = ((_silence_ns(*both), row) for row, both in enumerate(pairwise(told), start=1))
    known = [(silent_ns, row) for silent_ns, row in silences if silent_ns is not None]
    if known:
        _merge(told, min(known)[1])
    else:
        del told[0]


def _silence_ns(before: HeatStretch, after: HeatStretch) -> int | None:
    """None: they are of two runs, or the unit's clock was set back between them."""
    if before.boot_id != after.boot_id or after.first_ns < before.last_ns:
        return None
    return after.first_ns - before.last_ns


def _merge(told: list[HeatStretch], row: int) -> None:
    """With the one before; nothing more is filled in between them."""
    before, after = told[row - 1], told[row]
    before.last_ns, before.last_degc = after.last_ns, after.last_degc
    del told[row]
