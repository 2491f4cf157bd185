"""Order of the modules of tests that run side by side.

Tests that wait for stations, links and pages leave the processors idle, and the others keep them
busy: modules of both are taken by turns.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

WAITING = ("e2e", "faults", "integration")  # folders of tests that wait more than they compute
WAITING_END = 2 / 3  # part of the order in which theirs are: at the end nobody waits for them


def by_turns(modules: Iterable[Path], tests: Path) -> list[Path]:
    """Return the modules with those of each folder of ``tests`` evenly among those of the others,
    in their own order.
    """
    folders: defaultdict[str, list[Path]] = defaultdict(list)
    for module in modules:
        inside = module.is_relative_to(tests)
        folders[module.relative_to(tests).parts[0] if inside else ""].append(module)
    places = {
        module: (WAITING_END if folder in WAITING else 1.0) * number / len(of_folder)
        for folder, of_folder in folders.items()
        for number, module in enumerate(of_folder)
    }
    return sorted(places, key=lambda module: places[module])
