"""Access rules from a registry; tests/integration checks them with Zenoh."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

import pytest

from base_station.security.pki.access import access_control, rate_limited_queries
from base_station.security.pki.registry import Entry, Registry
from shared.channels import (
    CHANNELS,
    COMMAND,
    EVERY_UNIT,
    Direction,
    alive_key,
    clock_key,
    raw_journal_key,
    tracker_id,
)
from shared.enrolment import Holder

INTERESTS = ("declare_subscriber", "declare_liveliness_subscriber", "liveliness_query")
THEN = datetime(2026, 3, 1, tzinfo=UTC)


def entry(holder: Holder, name: str, common_name: str, revoked: datetime | None = None) -> Entry:
    return Entry(holder, name, common_name, "1", THEN, THEN, revoked)


@pytest.fixture
def registry() -> Registry:
    return Registry(
        "Test",
        (),
        (),
        (
            entry(Holder.STATION, "station", "station"),
            entry(Holder.UNIT, "anna", "anna", revoked=THEN),
            entry(Holder.UNIT, "anna", "anna#2"),
            entry(Holder.UNIT, "bert", "bert"),
            entry(Holder.TRACKER, "bert", "bert@tracker"),
            entry(Holder.OPERATOR, "chief", "operator:chief"),
        ),
    )


@pytest.fixture
def rules(registry: Registry) -> dict[str, Any]:
    return access_control(registry)


def allowed(rules: dict[str, Any], common_name: str, flow: str, message: str) -> set[str]:
    """Key expressions under which the holder of a common name may do an action."""
    subjects = {s["id"] for s in rules["subjects"] if common_name in s["cert_common_names"]}
    ids = {r for p in rules["policies"] if subjects & set(p["subjects"]) for r in p["rules"]}
    return {
        key
        for rule in rules["rules"]
        if rule["id"] in ids and flow in rule["flows"] and message in rule["messages"]
        for key in rule["key_exprs"]
    }


def test_action_without_a_rule_is_denied(rules: dict[str, Any]) -> None:
    assert rules["enabled"] is True
    assert rules["default_permission"] == "deny"
    assert {rule["permission"] for rule in rules["rules"]} == {"allow"}


def test_every_rule_and_subject_that_is_named_exists_once(rules: dict[str, Any]) -> None:
    rule_ids = [rule["id"] for rule in rules["rules"]]
    subject_ids = [subject["id"] for subject in rules["subjects"]]
    assert len(set(rule_ids)) == len(rule_ids)
    assert len(set(subject_ids)) == len(subject_ids)
    for policy in rules["policies"]:
        assert set(policy["rules"]) <= set(rule_ids)
        assert set(policy["subjects"]) <= set(subject_ids)


def test_every_subject_is_one_exact_common_name(rules: dict[str, Any]) -> None:
    # An empty subject would match everybody.
    assert all(len(subject["cert_common_names"]) == 1 for subject in rules["subjects"])


def test_unit_has_its_rights_and_no_others(rules: dict[str, Any]) -> None:
    assert rights(rules, "bert") == rights_of_sender("bert")


def test_tracking_agent_is_a_unit_that_receives_the_raw_stream_of_another(
    rules: dict[str, Any],
) -> None:
    name = tracker_id("bert")
    more = rights_of_sender(name)
    raw = {"muster/v1/bert/up/imu", "muster/v1/bert/up/description"}
    more["ingress", "declare_subscriber"] |= raw
    more["egress", "put"] |= raw
    more["egress", "declare_queryable"] |= {"muster/v1/bert/journal/**"}
    for flow, message in (("ingress", "query"), ("egress", "reply")):
        more[flow, message] |= {raw_journal_key("bert")}
    assert rights(rules, name) == more


def rights(rules: dict[str, Any], common_name: str) -> dict[tuple[str, str], set[str]]:
    """Rights of the holder of a common name: actions and their key expressions."""
    reported = {message for rule in rules["rules"] for message in rule["messages"]}
    every = ((flow, message) for flow in ("ingress", "egress") for message in reported)
    found = {one: allowed(rules, common_name, *one) for one in every}
    return {one: keys for one, keys in found.items() if keys}


def rights_of_sender(name: str) -> dict[tuple[str, str], set[str]]:
    """Rights of a unit, or of an agent that tracks for one, under its own key."""
    own, clock = f"muster/v1/{name}/**", clock_key(name)
    return {
        ("ingress", "put"): {c.key(name) for c in CHANNELS if c.direction is Direction.UP},
        ("ingress", "liveliness_token"): {alive_key(name)},
        ("ingress", "declare_queryable"): {own},
        ("ingress", "reply"): {own},
        ("ingress", "query"): {clock},
        ("ingress", "declare_subscriber"): {own, COMMAND.key(EVERY_UNIT)},
        ("egress", "put"): {own, COMMAND.key(EVERY_UNIT)},
        ("egress", "query"): {own, COMMAND.key(EVERY_UNIT)},
        ("egress", "reply"): {clock},
        ("egress", "declare_queryable"): {clock_key("*")},
    } | {("egress", interest): {"muster/v1/**"} for interest in INTERESTS}


def test_revoked_certificate_has_no_rule_and_its_successor_has(rules: dict[str, Any]) -> None:
    assert allowed(rules, "anna", "ingress", "put") == set()
    assert "muster/v1/anna/up/position" in allowed(rules, "anna#2", "ingress", "put")


def test_operator_only_subscribes(rules: dict[str, Any]) -> None:
    asks = {("ingress", interest): {"muster/v1/**"} for interest in INTERESTS}
    receives = {("egress", message): {"muster/v1/**"} for message in ("put", "liveliness_token")}
    assert rights(rules, "operator:chief") == asks | receives


def test_only_the_station_may_do_everything_below_the_roots(
    rules: dict[str, Any],
) -> None:
    everything = {"muster/v1/**", "muster/stations/v1/**", "muster/department/v1/**"}
    messages = ("put", "delete", "query", "reply", "declare_queryable", "liveliness_token")
    assert rights(rules, "station") == {
        (flow, message): everything
        for flow in ("ingress", "egress")
        for message in (*messages, *INTERESTS)
    }


def test_each_queries_the_time_under_a_key_of_its_own(registry: Registry) -> None:
    assert rate_limited_queries(registry) == tuple(map(clock_key, ("anna", "bert", "bert@tracker")))


def test_station_of_a_department_may_report_under_its_own_key_and_nothing_else() -> None:
    name = "department-station:engine-7"
    registry = Registry("City", (), (), (entry(Holder.DEPARTMENT_STATION, "engine-7", name),))
    own = "muster/department/v1/engine-7"
    assert rights(access_control(registry), name) == {
        ("ingress", "put"): {f"{own}/summary"},
        ("ingress", "query"): {f"{own}/events"},
        ("egress", "reply"): {f"{own}/events"},
        ("egress", "declare_subscriber"): {
            "muster/department/v1/*/summary",
            "muster/department/v1/*/events",
        },
        ("egress", "declare_queryable"): {
            "muster/department/v1/*/summary",
            "muster/department/v1/*/events",
        },
    }
