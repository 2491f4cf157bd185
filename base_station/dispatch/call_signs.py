"""Call signs of vehicles and crews: in words, and matched with known crews and units."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import msgspec

# Letters that fire departments of North America usually write; settings overrule them.
USUAL_WORDS: Mapping[str, str] = {
    "A": "Ambulance",
    "AMB": "Ambulance",
    "B": "Battalion",
    "BAT": "Battalion",
    "BC": "Battalion chief",
    "BR": "Brush",
    "E": "Engine",
    "ENG": "Engine",
    "HM": "Hazmat",
    "L": "Ladder",
    "LAD": "Ladder",
    "M": "Medic",
    "Q": "Quint",
    "R": "Rescue",
    "RES": "Rescue",
    "SQ": "Squad",
    "T": "Truck",
    "TK": "Truck",
    "TRK": "Truck",
    "WT": "Water tender",
}
_PART = re.compile(r"[^\W\d_]+|\d+")


class KnownUnit(msgspec.Struct, frozen=True):
    """A wearable that the station knows."""

    unit_id: str
    label: str


class MatchedCallSign(msgspec.Struct, frozen=True):
    """Crew or wearables at the station for which a call sign stands, or none."""

    call_sign: str
    words: str  # "Engine 12" for E12
    crew: str  # empty: none
    unit_ids: tuple[str, ...]

    @property
    def is_known(self) -> bool:
        return bool(self.crew or self.unit_ids)


class CallSigns:
    """Reader of call signs by the letters of a department."""

    def __init__(self, words: Mapping[str, str]) -> None:
        """``words``: words of the settings by letters; they have priority over the usual ones."""
        self._words = {letters.casefold(): word for letters, word in USUAL_WORDS.items()}
        self._words |= {letters.casefold(): word for letters, word in words.items()}

    def in_words(self, call_sign: str) -> str:
        """Readable form of a call sign; unknown parts are not changed."""
        parts = _PART.findall(call_sign)
        word = self._words.get(parts[0].casefold()) if len(parts) == 2 else None
        return call_sign if word is None or not parts[1].isdigit() else f"{word} {parts[1]}"

    def matched(
        self, call_signs: Iterable[str], crews: Iterable[str], units: Iterable[KnownUnit]
    ) -> tuple[MatchedCallSign, ...]:
        """Each call sign with the crew and the wearables of the same name, however it is
        written.
        """
        crew_by_key = {self._key(crew): crew for crew in crews}
        ids_by_key: dict[tuple[str, ...], set[str]] = {}
        for unit in units:
            for name in (unit.unit_id, unit.label):
                ids_by_key.setdefault(self._key(name), set()).add(unit.unit_id)
        return tuple(
            MatchedCallSign(
                call_sign,
                self.in_words(call_sign),
                crew_by_key.get(key, "") if key else "",
                tuple(sorted(ids_by_key.get(key, ()))) if key else (),
            )
            for call_sign in call_signs
            for key in [self._key(call_sign)]
        )

    def _key(self, name: str) -> tuple[str, ...]:
        """Key that E12, E-12, Eng.  012 and Engine 12 have in common; empty if it names nothing."""
        parts = [part.casefold() for part in _PART.findall(name)]
        in_full = [self._words.get(part, part).casefold() for part in parts]
        return tuple(part.lstrip("0") or part for word in in_full for part in word.split())
