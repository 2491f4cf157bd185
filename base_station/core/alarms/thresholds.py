"""Thresholds of alarm rules that a station's settings may change.

A field of a rule that is ``Annotated`` with its limits is one.  A set of thresholds has keys
``rule.field``, as in ``no-motion.alarm_s``; those that are not in it have their defaults.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, cast, get_type_hints

import msgspec

from base_station.core.alarms.interface import AlarmRule
from shared.config import nearest
from shared.errors import ConfigError

Thresholds = dict[str, float]


def thresholds_of(
    rules: Sequence[AlarmRule], settings: Mapping[str, Mapping[str, float]]
) -> Thresholds:
    """Return the thresholds of a station's settings that are not the defaults.

    Raises ConfigError where no rule has such a threshold, or cannot have such a value.
    """
    found = {}
    for rule_name, values in settings.items():
        rule = _rule_of_name(rules, rule_name)
        for name, value in values.items():
            require_threshold(rules, rule_name, name, value)
            if value != getattr(rule, name):
                found[f"{rule_name}.{name}"] = value
        try:
            changed_rule(rule, found)
        except ConfigError as error:
            raise ConfigError(f"alarms.{rule_name}: {error}") from error
    return found


def require_threshold(rules: Sequence[AlarmRule], rule_name: str, name: str, value: float) -> None:
    """Raises ConfigError where no rule has such a threshold, or where it cannot have the value."""
    limits = limits_of(_rule_of_name(rules, rule_name))
    where = f"alarms.{rule_name}.{name}"
    if name not in limits:
        known = nearest(name, limits, limits) if limits else f"{rule_name} has none"
        raise ConfigError(f"{where} is not a setting; {known}")
    try:
        msgspec.convert(value, limits[name])
    except msgspec.ValidationError as error:
        raise ConfigError(f"{where}: {error}") from error


def _rule_of_name(rules: Sequence[AlarmRule], rule_name: str) -> AlarmRule:
    by_name = {rule.name: rule for rule in rules}
    if rule_name not in by_name:
        raise ConfigError(f"alarms.{rule_name} is no alarm; {nearest(rule_name, by_name, by_name)}")
    return by_name[rule_name]


def with_thresholds(rules: Sequence[AlarmRule], thresholds: Thresholds) -> tuple[AlarmRule, ...]:
    """Return the rules with a log's thresholds; a rule that refuses those of another version keeps
    its defaults.
    """
    return tuple(_changed_or_as_it_was(rule, thresholds) for rule in rules)


def _changed_or_as_it_was(rule: AlarmRule, thresholds: Thresholds) -> AlarmRule:
    try:
        return changed_rule(rule, thresholds)
    except (ConfigError, msgspec.ValidationError):
        return rule


def changed_rule(rule: AlarmRule, thresholds: Thresholds) -> AlarmRule:
    """Return the rule with these thresholds.

    Raises ValidationError where one is beyond its limits, ConfigError where they do not
    go together.
    """
    changes = {
        name: msgspec.convert(thresholds[key], limits)
        for name, limits in limits_of(rule).items()
        if (key := f"{rule.name}.{name}") in thresholds
    }
    return cast("AlarmRule", dataclasses.replace(cast("Any", rule), **changes)) if changes else rule


def limits_of(rule: AlarmRule) -> Mapping[str, Any]:
    """Return the type and limits of each threshold."""
    return _limits_of(type(rule))


def bounds_of(rule: AlarmRule) -> Mapping[str, tuple[float, float]]:
    """Lowest and highest value of each threshold."""
    return {name: _bounds(limits) for name, limits in limits_of(rule).items()}


def _bounds(limits: Any) -> tuple[float, float]:
    (within,) = (one for one in limits.__metadata__ if isinstance(one, msgspec.Meta))
    if within.ge is None or within.le is None:
        raise TypeError("a threshold needs both limits (shared.config.Within)")
    return float(within.ge), float(within.le)


@cache
def _limits_of(kind: type[AlarmRule]) -> Mapping[str, Any]:
    hints = get_type_hints(kind, include_extras=True)
    return {name: hint for name, hint in hints.items() if hasattr(hint, "__metadata__")}
