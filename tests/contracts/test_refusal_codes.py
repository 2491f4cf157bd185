"""Refusals that the API answers have codes: those without are listed, and the list only shrinks."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tests.conftest import PROJECT_ROOT

_LISTED = Path(__file__).with_name("refusals_without_code.txt")
_PACKAGES = ("base_station", "shared")
# Programs of the command line, settings that are read at a start, and what only they raise.
_NOT_OF_THE_API = (
    "base_station/app/",
    "base_station/archive/",
    "base_station/cli.py",
    "base_station/config.py",
    "base_station/core/alarms/",
    "base_station/department/",
    "base_station/drawings/__main__.py",
    "base_station/forwarders/",
    "base_station/foxglove/",
    "base_station/privacy/requests.py",
    "base_station/radio/config.py",
    "base_station/replay/rehearsal/",
    "base_station/security/router/",
    "base_station/standby/",
    "base_station/storage/db/",
    "shared/",
)
_BUT_THESE = ("base_station/storage/db/accounts.py", "base_station/storage/db/roster.py")
_TEXT_AT = {
    "Problem": 1,
    "UserError": 0,
    "ConfigError": 0,
    "StoreError": 0,
    "LogError": 0,
    "ArchiveError": 0,
    "DiskHangsError": 0,
    "DatabaseAwayError": 0,
    "DiskFullError": 0,
    "MemoryLimitError": 0,
}


def uncoded_refusals(source: str) -> Iterator[int]:
    """Lines of refusals whose text is a plain one: written there, or where its name is bound."""
    tree = ast.parse(source)
    plain = {
        target.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign) and _is_plain(node.value)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)):
            continue
        place = _TEXT_AT.get(node.func.id)
        if place is None or len(node.args) <= place:
            continue
        text = node.args[place]
        if _is_plain(text) or (isinstance(text, ast.Name) and text.id in plain):
            yield node.lineno


def _is_plain(node: ast.expr) -> bool:
    """True for a text, one with values in it, and ``str(error)``, which leaves the code behind."""
    if isinstance(node, ast.Constant):
        return isinstance(node.value, str)
    is_str = (
        isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "str"
    )
    return is_str or isinstance(node, ast.JoinedStr)


def found() -> Counter[str]:
    counts: Counter[str] = Counter()
    for package in _PACKAGES:
        for path in sorted((PROJECT_ROOT / package).rglob("*.py")):
            name = str(path.relative_to(PROJECT_ROOT))
            if name in _BUT_THESE or not name.startswith(_NOT_OF_THE_API):
                counts[name] += sum(1 for _ in uncoded_refusals(path.read_text()))
    return +counts


def listed() -> Counter[str]:
    lines = (line.rpartition(" ") for line in _LISTED.read_text().splitlines() if line)
    return Counter({name: int(count) for name, _, count in lines})


def test_plain_texts_are_found() -> None:
    source = """
_NONE = "There is none."
_CODED = coded("none", "There is none.")
raise Problem(404, _NONE)
raise Problem(404, _CODED)
raise Problem(404, f"There is no {thing}.")
raise Problem(404, str(error))
raise Problem(404, text_of_error(error))
raise UserError(coded("none-of", "There is no {thing}.", thing=thing))
raise UserError("there is none")
"""
    assert list(uncoded_refusals(source)) == [4, 6, 7, 10]


def test_every_other_refusal_has_a_code() -> None:
    assert found() - listed() == Counter(), "give these refusals codes (shared.coded_text.coded)"


def test_list_of_those_without_shrinks_with_them() -> None:
    assert listed() - found() == Counter(), f"lower these numbers in {_LISTED.name}"
