"""Processes of a station: the one that was started, and those that it started."""

from __future__ import annotations

from pathlib import Path

import psutil


def cpu_s(pid: int) -> float:
    """Spent since they began."""
    return sum(sum(one.cpu_times()[:2]) for one in _family(pid))


def memory_mb(pid: int) -> float:
    return sum(float(one.memory_info().rss) for one in _family(pid)) / 1e6


def _family(pid: int) -> list[psutil.Process]:
    parent = psutil.Process(pid)
    return [parent, *parent.children(recursive=True)]


def peak_memory_mb(pid: int) -> float:
    """The most that each of them ever had; on Linux."""
    return sum(_peak_mb(one.pid) for one in _family(pid))


def _peak_mb(pid: int) -> float:
    status = Path(f"/proc/{pid}/status").read_text()
    [line] = (line for line in status.splitlines() if line.startswith("VmHWM:"))
    return int(line.split()[1]) * 1024 / 1e6
