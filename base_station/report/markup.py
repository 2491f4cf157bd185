"""HTML and SVG as text, in which everything that is not markup is escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from shared.xml_text import in_xml

_EMPTY = frozenset({"meta", "br", "img"})
JPEG_ADDRESS = "data:image/jpeg;base64,"  # before a picture that is in the page itself (RFC 2397)
_SHORT = 12  # characters


class Markup(str):
    """Text that is markup already and is not escaped."""

    __slots__ = ()


Child = str | Iterable[str]


def element(tag: str, *children: Child, **attributes: str | float | None) -> Markup:
    """Element as markup.  ``class_`` is the attribute class, ``stroke_width`` stroke-width; an
    attribute that is None is left out.
    """
    given = "".join(
        f' {name.rstrip("_").replace("_", "-")}="{_text(_number(value))}"'
        for name, value in attributes.items()
        if value is not None
    )
    if tag in _EMPTY:
        return Markup(f"<{tag}{given}>")
    return Markup(f"<{tag}{given}>{joined(*children)}</{tag}>")


def joined(*children: Child) -> Markup:
    return Markup("".join(_text(one) for child in children for one in _each(child)))


def table(headings: Sequence[str], rows: Iterable[Sequence[str]], class_: str = "") -> Markup:
    """Table with rows of texts or markup."""
    head = element("tr", (element("th", one, scope="col") for one in headings))
    body = (
        element(
            "tr",
            (element("td", _kept_together(cell)) for cell in row),
            class_="urgent" if isinstance(row, UrgentRow) else None,
        )
        for row in rows
    )
    return element("table", element("thead", head), element("tbody", body), class_=class_ or None)


class UrgentRow(tuple[str, ...]):
    """Row of a table that stands out, also in black and white."""

    __slots__ = ()


def _kept_together(cell: str) -> str:
    """Short text without line breaks, as a narrow column would break any word."""
    is_short = not isinstance(cell, Markup) and len(cell) <= _SHORT
    return element("span", cell, class_="one-line") if is_short else cell


def _each(child: Child) -> Iterable[str]:
    return (child,) if isinstance(child, str) else child


def _text(text: str) -> str:
    return text if isinstance(text, Markup) else escape(in_xml(text))


def _number(value: str | float) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.1f}".removesuffix(".0")
