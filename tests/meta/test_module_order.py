"""Modules of tests that wait and of tests that compute come by turns."""

from __future__ import annotations

from pathlib import Path

from tests.rig.module_order import WAITING, WAITING_END, by_turns

TESTS = Path(__file__).resolve().parents[1]
ALONE = TESTS / "e2e/crowd"  # behind all others
MODULES = sorted(one for one in TESTS.rglob("test_*.py") if not one.is_relative_to(ALONE))


def test_every_module_comes_once_and_those_of_a_folder_in_their_order() -> None:
    ordered = by_turns(MODULES, TESTS)
    assert sorted(ordered) == MODULES
    for folder in (TESTS / "faults", TESTS / "unit"):
        of_folder = [one for one in ordered if one.is_relative_to(folder)]
        assert of_folder == sorted(of_folder)


def test_each_tenth_before_the_end_has_waiting_modules_and_others_and_the_end_has_none() -> None:
    assert all((TESTS / folder).is_dir() for folder in WAITING)
    waits = [one.relative_to(TESTS).parts[0] in WAITING for one in by_turns(MODULES, TESTS)]
    last = max(number for number, one in enumerate(waits) if one)
    tenth = last // 10
    parts = [waits[first : first + tenth] for first in range(0, last - tenth, tenth)]
    assert all(0.2 < sum(part) / tenth < 0.8 for part in parts)
    assert last < (WAITING_END + 0.1) * len(waits)
