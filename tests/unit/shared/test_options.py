"""Checks of options that their parsers do not make."""

from __future__ import annotations

import pytest
import typer

from shared.options import finite, number_within


@pytest.mark.parametrize(
    ("text", "number"),
    [("25", 25.0), ("2e3", 2000.0), ("24.9", None), ("nan", None), ("inf", None), ("fast", None)],
)
def test_number_within_limits_is_taken(text: str, number: float | None) -> None:
    assert number_within(text, 25.0, 2000.0) == number


def test_option_that_is_no_finite_number_is_refused() -> None:
    assert finite(0.5) == 0.5
    assert finite(None) is None
    for value in (float("nan"), float("inf")):
        with pytest.raises(typer.BadParameter):
            finite(value)
