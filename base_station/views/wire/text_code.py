"""View of the code of a sentence."""

from __future__ import annotations

from base_station.views.answer import Answer


class TextCodeView(Answer, frozen=True):
    """Code and parameters of a sentence, from which a console makes it in its own language."""

    code: str  # empty: there is the sentence alone
    texts: dict[str, str]  # parameters, by name
    numbers: dict[str, float]  # with their units in their names
