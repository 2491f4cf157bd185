"""Call signs in words, and the crews and units that they mean."""

from __future__ import annotations

import pytest

from base_station.dispatch.call_signs import CallSigns, KnownUnit


@pytest.mark.parametrize(
    ("call_sign", "words"),
    [("E12", "Engine 12"), ("e-12", "Engine 12"), ("L4", "Ladder 4"), ("Engine 12", "Engine 12"),
     ("HLF 20/1", "HLF 20/1"), ("12", "12"), ("X9", "X9"), ("--", "--"), ("", "")],
)  # fmt: skip
def test_words(call_sign: str, words: str) -> None:
    assert CallSigns({}).in_words(call_sign) == words


def test_settings_come_before_the_usual_words() -> None:
    signs = CallSigns({"e": "Einsatzleitwagen", "DLK": "Drehleiter"})
    assert signs.in_words("E12") == "Einsatzleitwagen 12"
    assert signs.in_words("DLK 3") == "Drehleiter 3"


def test_known_call_sign_is_matched_in_any_spelling() -> None:
    units = [KnownUnit("E12-A", "hose"), KnownUnit("FF-07", "ladder 4"), KnownUnit("FF-08", "--")]
    found = CallSigns({}).matched(
        ("E12", "L04", "E12-a", "E1", "HLF 20/1", "--"), ("Engine 12", "hlf 20-1", "--"), units
    )
    assert [(one.call_sign, one.crew, one.unit_ids) for one in found] == [
        ("E12", "Engine 12", ()),
        ("L04", "", ("FF-07",)),
        ("E12-a", "", ("E12-A",)),
        ("E1", "", ()),
        ("HLF 20/1", "hlf 20-1", ()),
        ("--", "", ()),
    ]
    assert [one.is_known for one in found] == [True, True, True, False, True, False]
