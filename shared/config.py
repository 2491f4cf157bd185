"""Settings from TOML files and flags into frozen dataclasses, with errors that help.

A configuration is a frozen dataclass; its fields may be anything that ``msgspec.convert``
makes from TOML (numbers, text, enumerations by value, ``Literal``, tuples, dicts, further
dataclasses) and ``Path``.  ``Annotated[float, Within(0.1, 100.0)]`` limits a number.
Every default stands in the dataclass and nowhere else.
"""

from __future__ import annotations

import dataclasses
import difflib
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from enum import Enum
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

import msgspec

from shared.errors import ConfigError

C = TypeVar("C")

_MISSING = re.compile(r"Object missing required field `(.*)`")

_UNITS = frozenset(
    re.findall(
        r"\w+",
        "hz khz mhz ns us ms s min h d mm cm m km mps kmh mps2 g deg rad mrad radps degps rpm "
        "pa hpa kpa degc degf k nt ut mt v mv a ma bytes kb mb gb kib mib gib percent fraction",
    )
)


def Within(low: float, high: float) -> msgspec.Meta:  # noqa: N802  # stands where a type does
    """The limits of a number in ``Annotated``; both ends are allowed."""
    return msgspec.Meta(ge=low, le=high)


def load_config(
    path: Path | None, config_class: type[C], flags: Mapping[str, object] | None = None
) -> C:
    """The configuration of the file at ``path`` (defaults when None), overruled by ``flags``.

    ``flags`` maps dotted keys (``"bus.connect"``) to values; None there means not given.
    Relative paths of the file are relative to its folder, paths among the flags are as they
    are.  Raises ConfigError that names each unknown key with the nearest known one, or the
    value that is missing, of the wrong type or out of range.
    """
    source = "command line" if path is None else str(path)
    table = {} if path is None else _read(path)
    for dotted, value in (flags or {}).items():
        if value is not None:
            _overrule(table, dotted, value)
    unknown = [f"{source}: {problem}" for problem in _unknown_keys(config_class, table, "")]
    if unknown:
        raise ConfigError("\n".join(unknown))

    def from_toml(hint: type, value: object) -> object:
        if hint is Path and isinstance(value, str):
            return Path(value) if path is None else path.parent / value
        if isinstance(value, hint):
            return value
        raise TypeError(f"{value!r} is no {hint.__name__}")

    try:
        return msgspec.convert(table, config_class, dec_hook=from_toml)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{source}: {_in_words(config_class, str(error))}") from error
    except ConfigError as error:  # from a dataclass's own check
        raise ConfigError(f"{source}: {error}") from error


def _read(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ConfigError(f"{path}: there is no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read: {error}") from error
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{path}: not valid TOML: {error}") from error


def _overrule(table: dict[str, Any], dotted: str, value: object) -> None:
    *sections, key = dotted.split(".")
    for section in sections:
        inner = table.setdefault(section, {})
        if not isinstance(inner, dict):
            return  # the file's own mistake; it is named when the section is converted
        table = inner
    table[key] = value


def _unknown_keys(hint: Any, value: object, where: str) -> Iterator[str]:
    """Message for each key, at any depth, that no dataclass has a field for."""
    if isinstance(hint, type) and dataclasses.is_dataclass(hint):
        if isinstance(value, dict):
            hints = get_type_hints(hint)
            for key, inner in value.items():
                if key in hints:
                    yield from _unknown_keys(hints[key], inner, f"{where}{key}.")
                else:
                    meant = nearest(key, hints, hints.keys() - value.keys())
                    yield f"{where}{key} is not a setting; {meant}"
    elif get_origin(hint) is tuple and isinstance(value, list):
        for index, inner in enumerate(value):
            yield from _unknown_keys(get_args(hint)[0], inner, f"{where[:-1]}[{index}].")
    elif get_origin(hint) is dict and isinstance(value, dict):
        for key, inner in value.items():
            yield from _unknown_keys(get_args(hint)[1], inner, f"{where}{key}.")
    else:  # a union: X | None
        for option in get_args(hint):
            yield from _unknown_keys(option, value, where)


def nearest(key: str, known: Iterable[str], absent: Iterable[str]) -> str:
    """The setting that was probably meant; those not given yet are the likelier ones."""
    stem, _, unit = key.rpartition("_")
    for name in sorted(known):
        if name.rpartition("_")[0] == stem and {unit, name.rpartition("_")[2]} <= _UNITS:
            return f"its unit is another: {name}"
    for candidates in (sorted(absent), sorted(known)):
        near = difflib.get_close_matches(key, candidates, n=1, cutoff=0.5)
        if near:
            return f"did you mean {near[0]}?"
    return f"known here: {', '.join(sorted(known))}"


def _in_words(config_class: type, problem: str) -> str:
    """``problem - at `$.a.b``` as ``a.b: problem``, with the choices where there are any."""
    what, _, at = problem.partition(" - at `$.")
    where = at.rstrip("`")
    if missing := _MISSING.fullmatch(what):
        return f"{f'{where}.' if where else ''}{missing[1]} is missing, and there is no usual value"
    choices = _choices(config_class, where) if "enum value" in what else []
    if choices:
        given = re.search(r"'(.*)'", what)
        near = difflib.get_close_matches(given.group(1), choices, n=1) if given else []
        what += f"; known: {', '.join(choices)}"
        what += f"; did you mean {near[0]}?" if near else ""
    return f"{where}: {what}" if where else what


def _choices(config_class: type, where: str) -> list[str]:
    hint: Any = config_class
    for name in where.split("."):
        hint = next((h for h in (hint, *get_args(hint)) if dataclasses.is_dataclass(h)), None)
        if hint is None:
            return []
        hint = get_type_hints(hint).get(name.partition("[")[0])
    options: list[str] = []
    for option in (hint, *get_args(hint)):
        if get_origin(option) is Literal:
            options += [str(choice) for choice in get_args(option)]
        elif isinstance(option, type) and issubclass(option, Enum):
            options += [str(member.value) for member in option]
    return options
