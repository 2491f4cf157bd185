"""Every reason that an assessment counts has its words in all catalogues of the console, which
finds them by the words of the station.  Those are read from the source.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest

from base_station.core.positioning.fixes import BEFORE_SITE
from base_station.fusion.gnss.fix_faults import FIX_FAULTS
from tests.conftest import PROJECT_ROOT
from tests.rig.console_catalogues import LANGUAGES, MESSAGE

_STATION = PROJECT_ROOT / "base_station"
_UNSETTLED = "heading not settled"  # its words are those of the tracker, up to the colon
_TEXT_AT = {"FixVerdict": 1, "Trust": 2}


def _tree(path: str) -> ast.AST:
    return ast.parse((_STATION / path).read_text())


def _texts(node: ast.AST) -> Iterator[str]:
    for one in ast.walk(node):
        if isinstance(one, ast.Constant) and isinstance(one.value, str) and one.value:
            yield one.value


def _arguments(path: str) -> Iterator[str]:
    """Texts given to ``FixVerdict`` and ``Trust``."""
    for node in ast.walk(_tree(path)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            place = _TEXT_AT.get(node.func.id)
            if place is not None and len(node.args) > place:
                argument = node.args[place]
                if not isinstance(argument, ast.Subscript | ast.Call):
                    yield from _texts(argument)


def _returns(path: str, function: str) -> Iterator[str]:
    for node in ast.walk(_tree(path)):
        if isinstance(node, ast.FunctionDef) and node.name == function:
            for one in ast.walk(node):
                if isinstance(one, ast.Return) and isinstance(one.value, ast.Constant | ast.IfExp):
                    yield from _texts(one)


def _sightings() -> Iterator[str]:
    for node in ast.walk(_tree("core/pins/sightings.py")):
        if isinstance(node, ast.FunctionDef) and node.name == "_rejection_reason":
            for pair in ast.walk(node):
                if isinstance(pair, ast.Tuple) and len(pair.elts) == 2:
                    yield from _texts(pair.elts[1])


def _qualities() -> Iterator[str]:
    """Sentences about the quality of a position, up to the colon."""
    for node in ast.walk(_tree("fusion/position_quality.py")):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "coded":
            head = ast.literal_eval(node.args[1]).partition(":")[0]
            if "{" not in head:
                yield head


def counted_reasons() -> set[str]:
    places = ("core/trust/trust.py", "core/positioning/fixes.py", "fusion/gnss_update.py")
    return {
        BEFORE_SITE,
        _UNSETTLED,
        *FIX_FAULTS.values(),
        *(text for path in (*places, "fusion/gnss/screening.py") for text in _arguments(path)),
        *_returns("fusion/path_estimates.py", "predict"),
        *_sightings(),
        *_qualities(),
    }


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_counted_reason_has_words(language: str) -> None:
    catalogue = _STATION / "console/src/language" / language / "assessment_reasons.ts"
    assert set(dict(MESSAGE.findall(catalogue.read_text()))) == counted_reasons()
