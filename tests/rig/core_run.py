"""Digest of what a station's core makes of incidents in which about everything happens.

python -m tests.rig.core_run    how many modules of it were machine code, and the digest
"""

from __future__ import annotations

import hashlib
import sys
from importlib.machinery import ExtensionFileLoader


def digest() -> str:
    """Digest of all decisions, of the saved state and of the picture of consoles."""
    from base_station.storage.db.known_people import person_lookup  # noqa: PLC0415
    from base_station.views.station import StationFacts, snapshot  # noqa: PLC0415
    from tests.rig.eventful_incident import incident  # noqa: PLC0415
    from tests.rig.logged_script import logged  # noqa: PLC0415
    from tests.rig.pinned_walk import pinned_walk  # noqa: PLC0415

    reported = hashlib.sha256()
    everything = incident()
    for script in (everything, pinned_walk().script):
        for t_ns, key, payload in logged(script):
            reported.update(f"{t_ns} {key} ".encode() + payload)
    reported.update(everything.pipeline.checkpoint())
    shown = snapshot(everything.pipeline.state, 1, StationFacts(), person_lookup({}), None)
    reported.update(repr((shown.units, shown.alarms, shown.commands)).encode())
    return reported.hexdigest()


def compiled_modules() -> int:
    """Modules of the project that are loaded as machine code."""
    return sum(
        name.startswith(("base_station.", "shared."))
        and isinstance(module.__loader__, ExtensionFileLoader)
        for name, module in sys.modules.items()
    )


if __name__ == "__main__":
    made = digest()
    print(compiled_modules(), made)
