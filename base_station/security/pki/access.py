"""Zenoh's access rules, made from the registry and the table of channels.

Deny is the default, so a certificate without an entry, or with a revoked one, can do nothing.
Zenoh reads the rules when the router opens; ``security.router.router`` reopens it on a change.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from base_station.security.pki.registry import Entry, Registry
from shared.channels import (
    CHANNELS,
    DEPARTMENT_ROOT,
    DESCRIPTION,
    EVERY_UNIT,
    IMU,
    ROOT,
    STATIONS_ROOT,
    Direction,
    alive_key,
    clock_key,
    department_events_key,
    department_summary_key,
    journal_keys,
    raw_journal_key,
    tracker_id,
)
from shared.enrolment import Holder

_EVERYTHING = [f"{ROOT}/**"]
_STATION_KEYS = [f"{STATIONS_ROOT}/**"]  # no other holder may publish or subscribe there
_DEPARTMENT_KEYS = [f"{DEPARTMENT_ROOT}/**"]
_ALL_MESSAGES = [
    "put",
    "delete",
    "query",
    "reply",
    "declare_subscriber",
    "declare_queryable",
    "liveliness_token",
    "declare_liveliness_subscriber",
    "liveliness_query",
]
_INTERESTS = ["declare_subscriber", "declare_liveliness_subscriber", "liveliness_query"]


def _rule(
    rule_id: str, flows: list[str], messages: list[str], keys: Iterable[str]
) -> dict[str, Any]:
    return {
        "id": rule_id,
        "permission": "allow",
        "flows": flows,
        "messages": messages,
        "key_exprs": list(keys),
    }


_CLOCK_RULES = {
    holder: _rule(
        f"{holder.name.lower()}-clock", ["egress"], ["declare_queryable"], [clock_key("*")]
    )
    for holder in (Holder.UNIT, Holder.TRACKER)
}
_RULES_OF_KIND = {
    Holder.STATION: (
        _rule(
            "station",
            ["ingress", "egress"],
            _ALL_MESSAGES,
            [*_EVERYTHING, *_STATION_KEYS, *_DEPARTMENT_KEYS],
        ),
    ),
    # A unit learns which keys the station subscribes to, so that it sends only those.
    Holder.UNIT: (_rule("unit", ["egress"], _INTERESTS, _EVERYTHING), _CLOCK_RULES[Holder.UNIT]),
    Holder.TRACKER: (
        _rule("tracker", ["egress"], _INTERESTS, _EVERYTHING),
        _CLOCK_RULES[Holder.TRACKER],
    ),
    # A station learns that its department is there, and nothing of other stations.
    Holder.DEPARTMENT_STATION: (
        _rule(
            "department-station",
            ["egress"],
            ["declare_subscriber", "declare_queryable"],
            [department_summary_key("*"), department_events_key("*")],
        ),
    ),
    # An operator's program only receives: all messages.
    Holder.OPERATOR: (
        _rule("operator-asks", ["ingress"], _INTERESTS, _EVERYTHING),
        _rule("operator-receives", ["egress"], ["put", "liveliness_token"], _EVERYTHING),
    ),
}


def access_control(registry: Registry, station_link: str | None = None) -> dict[str, Any]:
    """The ``access_control`` section of the router's configuration.

    ``station_link``: the protocol that only this station's own program uses, which needs no
    certificate then.
    """
    rules = [rule for rules_of_kind in _RULES_OF_KIND.values() for rule in rules_of_kind]
    subjects: list[dict[str, Any]] = []
    policies: list[dict[str, Any]] = []
    if station_link is not None:
        allowed = [rule["id"] for rule in _RULES_OF_KIND[Holder.STATION]]
        subjects.append({"id": station_link, "link_protocols": [station_link]})
        policies.append({"rules": allowed, "subjects": [station_link]})
    for entry in registry.entries:
        if entry.revoked is not None:
            continue
        own_rules = _own_rules(entry)
        rules += own_rules
        allowed = [rule["id"] for rule in (*_RULES_OF_KIND[entry.holder], *own_rules)]
        subjects.append({"id": entry.common_name, "cert_common_names": [entry.common_name]})
        policies.append({"rules": allowed, "subjects": [entry.common_name]})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def rate_limited_queries(registry: Registry) -> tuple[str, ...]:
    """Keys under which those who are enrolled ask the station something, each its own."""
    asking = (
        tracker_id(entry.name) if entry.holder is Holder.TRACKER else entry.name
        for entry in registry.entries
        if entry.holder in (Holder.UNIT, Holder.TRACKER) and entry.revoked is None
    )
    return tuple(clock_key(sender_id) for sender_id in dict.fromkeys(asking))


def _own_rules(entry: Entry) -> list[dict[str, Any]]:
    """Rules for the holder of this one certificate only."""
    if entry.holder is Holder.UNIT:
        return _unit_rules(entry, entry.name)
    if entry.holder is Holder.TRACKER:
        return [*_unit_rules(entry, tracker_id(entry.name)), *_tracking_rules(entry)]
    if entry.holder is Holder.DEPARTMENT_STATION:
        return _department_station_rules(entry)
    return []


def _tracking_rules(entry: Entry) -> list[dict[str, Any]]:
    """It receives the raw stream of its unit and fetches missed parts of it; it publishes under its
    own key only.
    """
    raw = [channel.key(entry.name) for channel in (IMU, DESCRIPTION)]
    name, lost = entry.common_name, raw_journal_key(entry.name)
    return [
        _rule(f"{name}-fetches", ["ingress"], ["query"], [lost]),
        _rule(f"{name}-is-given", ["egress"], ["reply"], [lost]),
        _rule(f"{name}-knows", ["egress"], ["declare_queryable"], [journal_keys(entry.name)]),
        _rule(f"{name}-follows", ["ingress"], ["declare_subscriber"], raw),
        _rule(f"{name}-receives-raw", ["egress"], ["put"], raw),
    ]


def _department_station_rules(entry: Entry) -> list[dict[str, Any]]:
    """It reports under its own key, and gets the receipts for its own events."""
    name, summary, events = (
        entry.common_name,
        department_summary_key(entry.name),
        department_events_key(entry.name),
    )
    return [
        _rule(f"{name}-reports", ["ingress"], ["put"], [summary]),
        _rule(f"{name}-hands-over", ["ingress"], ["query"], [events]),
        _rule(f"{name}-is-answered", ["egress"], ["reply"], [events]),
    ]


def _unit_rules(entry: Entry, unit_id: str) -> list[dict[str, Any]]:
    subtree = f"{ROOT}/{unit_id}/**"
    commands = [c for c in CHANNELS if c.direction is Direction.DOWN]
    to_all = [channel.key(EVERY_UNIT) for channel in commands]
    speaks = [c.key(unit_id) for c in CHANNELS if c.direction is Direction.UP]
    name = entry.common_name
    return [
        _rule(f"{name}-speaks", ["ingress"], ["put"], speaks),
        _rule(f"{name}-lives", ["ingress"], ["liveliness_token"], [alive_key(unit_id)]),
        _rule(f"{name}-answers", ["ingress"], ["declare_queryable", "reply"], [subtree]),
        _rule(f"{name}-listens", ["ingress"], ["declare_subscriber"], [subtree, *to_all]),
        _rule(f"{name}-receives", ["egress"], ["put", "query"], [subtree, *to_all]),
        _rule(f"{name}-asks-time", ["ingress"], ["query"], [clock_key(unit_id)]),
        _rule(f"{name}-receives-time", ["egress"], ["reply"], [clock_key(unit_id)]),
    ]
