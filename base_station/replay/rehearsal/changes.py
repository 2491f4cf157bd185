"""Thresholds that are rehearsed, as a person gives them: ``no-motion.alarm_s=25``, and as a sweep
``no-motion.alarm_s=15:60:5``.  The name of a rule may have underscores in place of hyphens.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from base_station.core.alarms import ALARMS
from base_station.core.alarms.thresholds import Thresholds, require_threshold
from shared.coded_text import coded
from shared.errors import UserError

MAX_POINTS = 100  # of a sweep: each is judged at every message
_NOTHING = coded("rehearsal-nothing", "no threshold is given")
_OF_PEOPLE = "rearm_after_s"
_ROUNDING = 1e-9  # of steps: 0.1 has no exact binary number


def change_of(text: str) -> tuple[str, float]:
    """Name and value of one threshold.

    Raises UserError where the text has another form, and ConfigError where there is no such
    threshold or where it cannot have this value.
    """
    key, value_text = _split(text, "no-motion.alarm_s=25")
    value = _number(key, value_text)
    _require(key, value)
    return key, value


def changes_of(texts: Iterable[str]) -> Thresholds:
    """Several of them; raises as ``change_of``, and UserError where one is given twice."""
    changes: Thresholds = {}
    for text in texts:
        key, value = change_of(text)
        if key in changes:
            raise UserError(f"{key} is given twice; give one value")
        changes[key] = value
    return changes


def sweep_of(text: str) -> tuple[str, Sequence[float]]:
    """Name and values, both ends included; raises as ``change_of``."""
    key, range_text = _split(text, "no-motion.alarm_s=15:60:5")
    parts = range_text.split(":")
    if len(parts) != 3:
        raise UserError(f"{key}: a sweep is FIRST:LAST:STEP, such as 15:60:5, not {range_text!r}")
    first, last, step = (_number(key, part) for part in parts)
    if step <= 0.0 or last < first:
        raise UserError(
            coded(
                "sweep-order",
                "{threshold}: a sweep goes up from its first to its last value by a step above 0",
                threshold=key,
            )
        )
    count = math.floor((last - first) / step + _ROUNDING) + 1
    if count > MAX_POINTS:
        raise UserError(
            coded(
                "sweep-long",
                "{threshold}: {count} values; at most {most}, take a longer step",
                threshold=key,
                count=count,
                most=MAX_POINTS,
            )
        )
    values = [round(first + step * number, 9) for number in range(count)]
    for value in values:
        _require(key, value)
    return key, values


def points_of(changes: Thresholds, sweep: str) -> tuple[str, Sequence[Thresholds]]:
    """The threshold that ``sweep`` changes, empty for none, and the sets of thresholds to rehearse.

    Raises as ``sweep_of``, and UserError where there is nothing to rehearse, or one threshold is
    given both ways.
    """
    if not sweep:
        if not changes:
            raise UserError(_NOTHING)
        return "", [changes]
    swept, values = sweep_of(sweep)
    if swept in changes:
        raise UserError(
            coded(
                "sweep-and-value",
                "{threshold} is given by a value and by a sweep; leave one of them out",
                threshold=swept,
            )
        )
    return swept, [changes | {swept: value} for value in values]


def can_be_rehearsed(name: str) -> bool:
    """``name``: of a threshold, without its rule."""
    return name != _OF_PEOPLE


def _split(text: str, example: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    rule_name, dot, field = name.strip().partition(".")
    if not (equals and dot):
        raise UserError(f"{text!r} is no threshold with its value; write it as in {example}")
    return f"{rule_name.replace('_', '-')}.{field}", value.strip()


def _number(key: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise UserError(f"{key}: {text!r} is no number") from None
    if not math.isfinite(value):
        raise UserError(f"{key}: {text!r} is no number that can be used here")
    return value


def _require(key: str, value: float) -> None:
    rule_name, _, field = key.partition(".")
    require_threshold(ALARMS, rule_name, field, value)
    if not can_be_rehearsed(field):
        raise UserError(
            f"{key} counts from when a person resolves an alarm; a rehearsal leaves out what "
            "people did with alarms, so it cannot show a difference"
        )
