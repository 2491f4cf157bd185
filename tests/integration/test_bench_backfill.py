"""``muster bench backfill``: a short backlog arrives complete beside live data."""

from __future__ import annotations

from rich.progress import Progress

from tests.bench.backfill import measure


def test_short_backlog_arrives_completely() -> None:
    with Progress(disable=True) as progress:
        report = measure(backlog=500, units=2, seconds=1.0, progress=progress, plain=True)
    assert (report.lost, report.repeated) == (0, 0)
    assert report.recorded > 500
    assert report.fetched_hz > 0.0
    assert report.before.count > 0
    assert report.meanwhile.count > 0
