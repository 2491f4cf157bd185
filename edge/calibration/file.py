"""Calibration files: TOML that a person can read, named by what is in them."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Iterator
from datetime import UTC
from math import isfinite
from pathlib import Path
from typing import Any

import msgspec

from edge.calibration.model import Calibration
from shared.errors import ConfigError
from shared.out_file import whole

_HEADLINE = "# Made by `muster edge calibrate`; units are in the names.\n"


def write_calibration(calibration: Calibration, path: Path) -> None:
    """Write the file; raises UserError where that is not possible."""
    with whole(path) as making:
        making.write_text(to_toml(calibration), encoding="utf-8")


def read_calibration(path: Path) -> Calibration:
    """Raises ConfigError that says what is wrong with the file."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        calibration = msgspec.convert(table, Calibration)
        if not all(map(isfinite, _numbers(table))):
            raise msgspec.ValidationError("a value that is no number")
        if calibration.made.tzinfo is None:
            raise ConfigError(
                f"calibration {path}: made has no time zone; write 2026-01-31T12:00:00Z"
            )
        if impossible := calibration.impossible():
            raise msgspec.ValidationError(impossible)
    except FileNotFoundError:
        raise ConfigError(f"there is no calibration file {path}; check the path") from None
    except OSError as error:
        raise ConfigError(f"calibration {path} cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, msgspec.ValidationError) as error:
        raise ConfigError(
            f"calibration {path} is damaged ({error}); make it anew with `muster edge calibrate`"
        ) from error
    return calibration


def identity(calibration: Calibration) -> str:
    """Short and the same for equal calibrations only: day, time and a digest of all numbers."""
    digest = hashlib.sha256(to_toml(calibration).encode()).hexdigest()[:8]
    return f"{calibration.made.astimezone(UTC):%Y%m%dT%H%M%SZ}-{digest}"


def to_toml(calibration: Calibration) -> str:
    lines = [_HEADLINE]
    tables: dict[str, Any] = {}
    for field, value in msgspec.structs.asdict(calibration).items():
        if isinstance(value, msgspec.Struct):
            tables[field] = value
        elif value is not None:
            lines.append(f"{field} = {_value(value)}")
    for name, table in tables.items():
        lines.append(f"\n[{name}]")
        lines += [
            f"{field} = {_value(value)}"
            for field, value in msgspec.structs.asdict(table).items()
            if value is not None
        ]
    return "\n".join(lines) + "\n"


def _numbers(value: Any) -> Iterator[float]:
    """Yield all numbers in a table."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for one in value:
            yield from _numbers(one)
    elif isinstance(value, float):
        yield value


def _value(value: Any) -> str:
    """Numbers by their shortest exact text; text as JSON has it, which TOML understands."""
    if hasattr(value, "astimezone"):
        return str(value.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"))
    if isinstance(value, tuple):
        return f"[{', '.join(_value(item) for item in value)}]"
    return msgspec.json.encode(value).decode() if isinstance(value, str) else repr(value)
