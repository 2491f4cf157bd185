"""Processes of a station: the one that was started, and those that it started."""

from __future__ import annotations

import psutil


def cpu_s(pid: int) -> float:
    """Spent since they began."""
    return sum(sum(one.cpu_times()[:2]) for one in _family(pid))


def memory_mb(pid: int) -> float:
    return sum(float(one.memory_info().rss) for one in _family(pid)) / 1e6


def _family(pid: int) -> list[psutil.Process]:
    parent = psutil.Process(pid)
    return [parent, *parent.children(recursive=True)]
