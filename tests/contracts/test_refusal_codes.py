"""Refusals that a console can show have codes."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tests.conftest import PROJECT_ROOT

_PACKAGES = ("base_station", "shared")
# Programs of the command line, settings that are read at a start, and what only they raise.
_NOT_OF_THE_API = (
    "base_station/app/",
    "base_station/cli.py",
    "base_station/config.py",
    "base_station/core/alarms/",
    "base_station/department/program.py",
    "base_station/department/replay_program.py",
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
    # Raised at the stop of the station, which shows it nowhere any more.
    "base_station/archive/automatic.py:_begin",
    # Raised at the start of the station.
    "base_station/api/server.py",
    # Commands at the station's machine.
    "base_station/api/routes/forgetting.py:accept_from_command",
    "base_station/privacy/erasure_queue.py:erase_now",
    "base_station/security/pki/folder.py:create",
    "base_station/security/pki/folder.py:_require_same_station",
    "base_station/security/pki/hosts.py",
    "base_station/security/pki/station_enrolment.py",
    "base_station/storage/data_folder.py",
    "base_station/storage/request_files.py",
    # Answers to programs that post samples, dispatches or alerts.
    "base_station/api/posted_samples.py",
    "base_station/api/routes/samples.py:post_samples",
    "base_station/engine/sample_intake.py",
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


def uncoded_refusals(source: str) -> Iterator[tuple[int, str]]:
    """Refusals whose text is a plain one, written there or where its name is bound: the line, and
    the function around it, empty for none.
    """
    tree = ast.parse(source)
    functions = {
        within: node.name
        for node in ast.walk(tree)  # the inner ones come later
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        for within in ast.walk(node)
    }
    plain = {
        target.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign) and _is_plain(node.value)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    composing = {
        node.name
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
        and any(isinstance(each, ast.Return) and _is_plain(each.value) for each in ast.walk(node))
    }
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)):
            continue
        place = _TEXT_AT.get(node.func.id)
        if place is None or len(node.args) <= place:
            continue
        text = node.args[place]
        is_composed = isinstance(text, ast.Call) and _name_of(text.func) in composing
        if _is_plain(text) or _name_of(text) in plain or is_composed:
            yield node.lineno, functions.get(node, "")


def _name_of(node: ast.expr) -> str:
    return node.id if isinstance(node, ast.Name) else ""


def _is_plain(node: ast.expr | None) -> bool:
    """True for a text, one with values in it, and ``str(error)``, which leaves the code behind."""
    if isinstance(node, ast.Constant):
        return isinstance(node.value, str)
    is_str = (
        isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "str"
    )
    return is_str or isinstance(node, ast.JoinedStr)


def found() -> list[str]:
    return [
        f"{name}:{line}"
        for package in _PACKAGES
        for path in sorted((PROJECT_ROOT / package).rglob("*.py"))
        if (name := str(path.relative_to(PROJECT_ROOT))) in _BUT_THESE
        or not name.startswith(_NOT_OF_THE_API)
        for line, function in uncoded_refusals(path.read_text())
        if f"{name}:{function}" not in _NOT_OF_THE_API
    ]


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
def refused():
    raise UserError("not here")
def _no(thing):
    return f"There is no {thing}."
raise Problem(404, _no(thing))
"""
    plain = [(4, ""), (6, ""), (7, ""), (10, ""), (12, "refused"), (15, "")]
    assert sorted(uncoded_refusals(source)) == plain


def test_every_refusal_of_the_api_has_a_code() -> None:
    assert found() == [], "give these refusals codes (shared.coded_text.coded)"


def test_each_exclusion_is_of_a_refusal() -> None:
    """A function that is renamed, or has no plain text any more, leaves the list."""
    functions = [one for one in _NOT_OF_THE_API if ":" in one]
    for one in functions:
        name, _, function = one.partition(":")
        uncoded = uncoded_refusals((PROJECT_ROOT / name).read_text())
        assert function in {each for _, each in uncoded}, one
