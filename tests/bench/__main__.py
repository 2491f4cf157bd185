"""``python -m tests.bench bench NAME``: benchmarks of a checkout; ``./muster bench NAME``."""

from __future__ import annotations

from importlib.metadata import EntryPoint

from shared.command_line import COMMANDS, run

BENCHES = {
    "activity": "tests.bench.tracker.activity:bench_activity",
    "aids": "tests.bench.tracker.aiding_sensors:bench_aids",
    "archive": "tests.bench.archive.command:bench_archive",
    "archive-outage": "tests.bench.archive.outage:bench_archive_outage",
    "backfill": "tests.bench.backfill:bench_backfill",
    "bus": "tests.bench.bus.command:bench_bus",
    "console": "tests.bench.console.command:bench_console",
    "constants": "tests.bench.tracker.constants:bench_constants",
    "department": "tests.bench.department:bench_department",
    "department-faults": "tests.bench.department_faults:bench_department_faults",
    "exports": "tests.bench.past.exports:bench_exports",
    "faults": "tests.bench.faults.command:bench_faults",
    "floors": "tests.bench.floors:bench_floors",
    "fusion": "tests.bench.fusion.command:bench_fusion",
    "instructions": "tests.bench.tracker.instructions:bench_instructions",
    "motions": "tests.bench.tracker.motions:bench_motions",
    "past": "tests.bench.past.command:bench_past",
    "phones": "tests.bench.phones.command:bench_phones",
    "published": "tests.bench.tracker.published:bench_published",
    "replay": "tests.bench.past.replay:bench_replay",
    "restart": "tests.bench.restart:bench_restart",
    "routes": "tests.bench.routes:bench_routes",
    "sensor": "tests.bench.sensor:bench_sensor",
    "standby": "tests.bench.standby.command:bench_standby",
    "station": "tests.bench.station.command:bench_station",
    "tak": "tests.bench.tak:bench_tak",
    "track": "tests.bench.tracker.track:bench_track",
    "wearer": "tests.bench.wearer:bench_wearer",
}


def bench_entry_points() -> list[EntryPoint]:
    """The benchmarks as commands of a group ``bench``."""
    return [EntryPoint(f"bench.{name}", value, COMMANDS) for name, value in BENCHES.items()]


if __name__ == "__main__":
    run(bench_entry_points())
