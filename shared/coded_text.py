"""Texts for a person with the code and the parameters that they are made of.

A console composes the text in its own language from the code; logs, programs and consoles that do
not know the code read the English text.  The template stands where the text is made: one code has
one template, and its placeholders are the parameters.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import LiteralString, NamedTuple

import msgspec


class TextCode(msgspec.Struct, frozen=True):
    """Code of a text, and its parameters, with their units in their names (``away_s``).

    Of a parameter ``reason`` that is itself a coded text, ``texts`` has the English text by its
    name, its code as ``reason:``, and its own parameters as ``reason:away_s``.
    """

    code: str = ""  # empty: the text has none
    texts: dict[str, str] = msgspec.field(default_factory=dict)
    numbers: dict[str, float] = msgspec.field(default_factory=dict)


NO_CODE = TextCode()


class Term(NamedTuple):
    """A parameter that is one of a few words: consoles have the code, English texts the words."""

    code: str
    words: str


class Measure(NamedTuple):
    """A number that the English text has in words of its own."""

    value: float
    words: str


class CodedText(str):
    """An English text that has its code with it.  ``str()`` gives the text alone, which structs
    and messages take.
    """

    __slots__ = ("code",)
    code: TextCode


def coded(
    code: LiteralString, template: LiteralString, /, **parameters: str | float | Term | Measure
) -> CodedText:
    """The text of ``template``, as of ``str.format``, with its code."""
    shown, texts, numbers = dict(parameters), {}, {}
    for name, one in parameters.items():
        if isinstance(one, Term):
            shown[name], texts[name] = one.words, one.code
        elif isinstance(one, Measure):
            shown[name], numbers[name] = one.words, float(one.value)
        elif isinstance(one, str):
            texts[name] = str(one)
            if (inner := code_of_text(one)).code:
                texts[f"{name}:"] = inner.code
                texts |= {f"{name}:{each}": text for each, text in inner.texts.items()}
                numbers |= {f"{name}:{each}": number for each, number in inner.numbers.items()}
        else:
            numbers[name] = float(one)
    text = CodedText(template.format(**shown))
    text.code = TextCode(code, texts, numbers)
    return text


def with_code(text: str, code: TextCode) -> str:
    """The text with a code that was stored or sent beside it."""
    if not code.code:
        return text
    joined = CodedText(text)
    joined.code = code
    return joined


def with_codes(texts: Sequence[str], codes: Sequence[TextCode]) -> tuple[str, ...]:
    """Texts with the codes that were stored or sent beside them, in their order; what an earlier
    version wrote has none.
    """
    return tuple(
        with_code(text, codes[at] if at < len(codes) else NO_CODE) for at, text in enumerate(texts)
    )


def code_of_text(text: str) -> TextCode:
    """The code of a text; ``NO_CODE`` where it has none."""
    return text.code if isinstance(text, CodedText) else NO_CODE


def text_of_error(error: Exception) -> str:
    """The text of an error, with its code where it was raised with a coded text."""
    first = error.args[0] if error.args else ""
    return first if isinstance(first, CodedText) else str(error)


def map_texts(text: str, change: Callable[[str], str]) -> str:
    """The text as ``change`` makes it, and so the texts among its parameters."""
    code = code_of_text(text)
    texts = {name: change(one) for name, one in code.texts.items()}
    return with_code(change(text), msgspec.structs.replace(code, texts=texts))


def join_texts(texts: Iterable[str]) -> str:
    """Those that are not empty, as one text; of several the codes are left out."""
    present = [text for text in texts if text]
    return present[0] if len(present) == 1 else "; ".join(present)
