"""Digest of what a station's core decides in incidents in which about everything happens.

python -m tests.rig.core_run [FOLDER]            with what FOLDER has of the core as machine code
python -m tests.rig.core_run --loaded FOLDER     only how much that is
"""

from __future__ import annotations

import hashlib
import sys
from importlib import import_module
from pathlib import Path

from base_station.process import compiled_core
from base_station.process.core_modules import CORE_MODULES


def digest() -> str:
    """Of all decisions, of the state that is saved, and of what consoles are shown."""
    from base_station.views.station import StationFacts, snapshot  # noqa: PLC0415
    from tests.golden import test_pins_replay, test_replay_equals_live  # noqa: PLC0415

    told = hashlib.sha256()
    everything = test_replay_equals_live.incident()
    for records in (
        test_replay_equals_live.logged(everything),
        test_pins_replay.logged(test_pins_replay.told()),
    ):
        for t_ns, key, payload in records:
            told.update(f"{t_ns} {key} ".encode() + payload)
    told.update(everything.pipeline.checkpoint())
    shown = snapshot(everything.pipeline.state, 1, StationFacts(), lambda _: None, None)
    told.update(repr((shown.units, shown.alarms, shown.commands)).encode())
    return told.hexdigest()


if __name__ == "__main__":
    *options, folder = sys.argv[1:] or [""]
    if folder:
        compiled_core.use(Path(folder))
    for name in CORE_MODULES:
        import_module(name)
    print(len(compiled_core.modules_in_use()), "-" if options else digest())
