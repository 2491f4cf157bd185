"""Rights on the bus, over Zenoh: access rules and revocation."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import pytest
import zenoh

from shared.bus_zenoh import ClientEndpoint
from shared.channels import (
    COMMAND,
    DESCRIPTION,
    EVERY_UNIT,
    GPS,
    IMU,
    POSITION,
    STATIONS_ROOT,
    Qos,
    alive_key,
    clock_key,
    tracker_id,
)
from shared.enrolment import Holder
from tests.rig.secured_bus import (
    QUIET_S,
    Site,
    assert_powerless,
    assert_speechless,
    publish_until_received,
    say_forged,
)
from tests.rig.waiting import until


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    with ExitStack() as stack:
        yield Site(tmp_path, stack)


def test_enrolled_unit_publishes_is_alive_receives_commands_and_answers(site: Site) -> None:
    enrolment = site.pki.enroll("anna")
    site.open()
    unit = site.unit(enrolment)
    commands: list[tuple[str, bytes]] = []
    for name in ("anna", EVERY_UNIT):
        unit.subscribe(COMMAND.key(name), lambda k, p: commands.append((k, p)))
    token = unit.declare_alive(alive_key("anna"))
    unit.serve("muster/v1/anna/journal/**", lambda *_: [b"entry"])
    publish_until_received(site, unit, "anna")
    until(lambda: site.alive == {alive_key("anna")}, "the token")
    for name in ("anna", EVERY_UNIT):
        key = COMMAND.key(name)
        until(partial(site.station.has_subscriber, key), "the unit's interest")
        site.station.publish(key, b"leave", Qos.ALERT)
    until(lambda: len(commands) == 2, "both commands")

    def answered() -> bool:
        return list(site.station.query("muster/v1/anna/journal/range", b"", 2.0)) == [b"entry"]

    until(answered, "the journal's answer")
    token.close()
    until(lambda: site.alive == set(), "the end of the token")


def test_unit_cannot_act_under_another_name(site: Site) -> None:
    anna, bert = site.pki.enroll("anna"), site.pki.enroll("bert")
    site.open()
    unit, other = site.unit(anna), site.unit(bert)
    overheard: list[tuple[str, bytes]] = []
    commanded: list[bytes] = []
    for name in ("bert", EVERY_UNIT):
        other.subscribe(COMMAND.key(name), lambda _, p: commanded.append(p))
    journal = other.serve("muster/v1/bert/journal/**", lambda *_: [b"entry"])
    for expression in ("muster/v1/**", "muster/v1/bert/**", "muster/v1/*/command/**"):
        unit.subscribe(expression, lambda key, payload: overheard.append((key, payload)))
    token = unit.declare_alive(alive_key("bert"))
    publish_until_received(site, unit, "anna")
    publish_until_received(site, other, "bert")
    until(lambda: site.station.has_subscriber(COMMAND.key("bert")), "bert's interest")
    forged = (
        POSITION.key("bert"),
        COMMAND.key("bert"),
        COMMAND.key("anna"),
        COMMAND.key(EVERY_UNIT),
        "muster/v1/station/tick",
    )
    for key in forged:
        say_forged(unit, key)
    site.station.publish(COMMAND.key("bert"), b"true", Qos.ALERT)
    until(lambda: commanded == [b"true"], "the true command")
    publish_until_received(site, other, "bert")
    assert b"forged" not in {payload for _, payload in site.received}
    assert commanded == [b"true"]
    assert alive_key("bert") not in site.alive
    # A session hears what it publishes itself; the rest would be the other's.
    assert set(overheard) - {(POSITION.key("anna"), b"here")} == {
        (key, b"forged") for key in forged
    }
    assert list(unit.query("muster/v1/bert/journal/range", b"", QUIET_S)) == []
    journal.close()
    unit.serve("muster/v1/bert/journal/**", lambda *_: [b"forged"])
    time.sleep(QUIET_S)
    assert list(site.station.query("muster/v1/bert/journal/range", b"", QUIET_S)) == []
    token.close()


def test_wildcards_deletes_and_admin_keys_are_refused(site: Site) -> None:
    """As whoever has taken a unit apart and writes a program of their own would try."""
    anna, bert = site.pki.enroll("anna"), site.pki.enroll("bert")
    site.open()
    unit, other = site.unit(anna), site.unit(bert)
    other.declare_alive(alive_key("bert"))
    other.serve("muster/v1/bert/journal/**", lambda *_: [b"entry"])
    kinds: list[tuple[str, bool]] = []

    def note(sample: zenoh.Sample) -> None:
        kinds.append((str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT))

    def forge(query: zenoh.Query) -> None:
        query.reply(query.key_expr, b"forged")

    watching = site.station._session.declare_subscriber("**", note)
    publish_until_received(site, unit, "anna")
    publish_until_received(site, other, "bert")
    session = unit._session
    beat = f"{STATIONS_ROOT}/first/beat"
    wide = ("muster/v1/*/up/position", "muster/v1/**", "muster/**", "**", f"{STATIONS_ROOT}/**")
    for key in (*wide, beat, "@/router/local"):
        session.put(key, b"forged")
        session.delete(key)
    session.delete(POSITION.key("anna"))
    queryables = [session.declare_queryable(key, forge) for key in wide]
    subscribers = [session.declare_subscriber(key) for key in (*wide, "@/**")]
    time.sleep(QUIET_S)
    publish_until_received(site, other, "bert")
    answers = list(site.station.query("muster/v1/bert/journal/range", b"", QUIET_S))
    assert answers == [b"entry"]
    for key in (*wide, "@/**", beat):
        replies = [one.ok for one in session.get(key, timeout=QUIET_S) if one.ok]
        # A session answers itself.
        others = [one for one in replies if str(session.zid()) not in str(one.key_expr)]
        assert {one.payload.to_bytes() for one in others} <= {b"forged"}
    tokens = session.liveliness().get("muster/v1/**", timeout=QUIET_S)
    assert [str(one.ok.key_expr) for one in tokens if one.ok] == []
    foreign = {POSITION.key("bert")}
    for subscriber in subscribers:
        while (sample := subscriber.try_recv()) is not None:
            assert str(sample.key_expr) not in foreign
    watching.undeclare()
    assert len(queryables) == len(wide)
    assert set(kinds) == {(POSITION.key("anna"), True), (POSITION.key("bert"), True)}


def test_tracking_agent_receives_its_units_raw_stream_and_publishes_only_as_itself(
    site: Site,
) -> None:
    anna, bert = site.pki.enroll("anna"), site.pki.enroll("bert")
    enrolment = site.pki.enroll("anna", Holder.TRACKER)
    site.open()
    units = {"anna": site.unit(anna), "bert": site.unit(bert)}
    ears = site.join(ClientEndpoint(enrolment.connect, enrolment.identity))
    bystander = site.join(ClientEndpoint(bert.connect, bert.identity))
    received: list[str] = []
    overheard: list[str] = []
    for expression in ("muster/v1/**", IMU.key("anna"), DESCRIPTION.key("anna"), IMU.key("bert")):
        ears.subscribe(expression, lambda key, _: received.append(key))
        bystander.subscribe(expression, lambda key, _: overheard.append(key))

    def raw_is_received() -> bool:
        for name, unit in units.items():
            for channel in (IMU, DESCRIPTION, GPS, POSITION):
                unit.publish(channel.key(name), b"of " + name.encode(), Qos.LIVE)
        return {IMU.key("anna"), DESCRIPTION.key("anna")} <= set(received)

    until(raw_is_received, "the raw stream")
    mouth = site.unit(enrolment)
    publish_until_received(site, mouth, tracker_id("anna"))
    time.sleep(QUIET_S)
    assert set(received) == {IMU.key("anna"), DESCRIPTION.key("anna")}
    assert IMU.key("anna") not in overheard
    token = mouth.declare_alive(alive_key("anna"))
    mouth.serve("muster/v1/anna/journal/**", lambda *_: [b"forged"])
    for key in (POSITION.key("anna"), POSITION.key(tracker_id("bert")), COMMAND.key("anna")):
        say_forged(mouth, key)
    say_forged(units["bert"], POSITION.key(tracker_id("anna")))
    say_forged(units["anna"], POSITION.key(tracker_id("anna")))
    publish_until_received(site, mouth, tracker_id("anna"))
    publish_until_received(site, units["bert"], "bert")
    time.sleep(QUIET_S)
    assert b"forged" not in {payload for _, payload in site.received}
    assert alive_key("anna") not in site.alive
    assert list(site.station.query("muster/v1/anna/journal/range", b"", QUIET_S)) == []
    token.close()


def test_a_tracking_agent_fetches_raw_samples_of_its_unit_and_nothing_else(site: Site) -> None:
    members = {name: site.pki.enroll(name) for name in ("anna", "bert")}
    enrolment = site.pki.enroll("anna", Holder.TRACKER)
    site.open()
    for name, member in members.items():
        site.unit(member).serve(f"muster/v1/{name}/journal/**", lambda key, *_: [key.encode()])
    ears = site.join(ClientEndpoint(enrolment.connect, enrolment.identity))
    raw = "muster/v1/anna/journal/raw"
    until(lambda: list(ears.query(f"{raw}?epoch=1", b"", 5.0)) == [raw.encode()], "raw samples")
    for other in ("muster/v1/anna/journal/range", "muster/v1/bert/journal/raw"):
        assert list(ears.query(other, b"", QUIET_S)) == []


def test_unit_gets_the_time_under_its_own_key_only(site: Site) -> None:
    anna, bert = site.pki.enroll("anna"), site.pki.enroll("bert")
    site.open()
    site.station.serve(clock_key("*"), lambda *_: [b"the time"])
    unit, other = site.unit(anna), site.unit(bert)
    other.serve(clock_key("anna"), lambda *_: [b"a wrong time"])
    until(lambda: list(unit.query(clock_key("anna"), b"", 5.0)) == [b"the time"], "the time")
    assert list(unit.query(clock_key("bert"), b"", QUIET_S)) == []


def test_a_certificate_of_the_authority_without_an_entry_can_do_nothing(site: Site) -> None:
    stray = site.pki.enroll("stray")
    registry = site.pki.registry()
    site.pki.registry_path.write_bytes(
        site.pki.registry_path.read_bytes().replace(b'"stray"', b'"other"')
    )
    assert site.pki.registry() != registry
    site.open()
    assert_powerless(site, stray)


def test_revoked_unit_is_disconnected_when_the_router_reopens(site: Site) -> None:
    anna, bert = site.pki.enroll("anna"), site.pki.enroll("bert")
    site.open()
    lost, kept = site.unit(anna), site.unit(bert)
    publish_until_received(site, lost, "anna")
    site.pki.revoke("anna")
    site.reopen()
    publish_until_received(site, kept, "bert")
    until(lost.is_linked, "the lost unit's link")
    assert_speechless(site, lost, "anna")


def test_revoked_certificate_stays_refused_after_a_new_enrolment(site: Site) -> None:
    stolen = site.pki.enroll("anna")
    site.pki.revoke("anna")
    again = site.pki.enroll("anna")
    site.open()
    assert_powerless(site, stolen)
    publish_until_received(site, site.unit(again), "anna")


def test_a_renewed_and_the_old_certificate_both_work(site: Site) -> None:
    old = site.pki.enroll("anna")
    new = site.pki.renew("anna")
    site.open()
    publish_until_received(site, site.unit(old), "anna")
    publish_until_received(site, site.unit(new), "anna")


def test_operator_receives_and_cannot_publish(site: Site) -> None:
    anna, operator = site.pki.enroll("anna"), site.pki.enroll("chief", Holder.OPERATOR)
    site.open()
    unit = site.unit(anna)
    commands: list[bytes] = []
    unit.subscribe(COMMAND.key("anna"), lambda _, p: commands.append(p))
    token = unit.declare_alive(alive_key("anna"))
    unit.serve("muster/v1/anna/journal/**", lambda *_: [b"entry"])
    onlooker = site.join(ClientEndpoint(operator.connect, operator.identity))
    seen: list[str] = []
    tokens: list[str] = []
    onlooker.subscribe("muster/v1/**", lambda key, _: seen.append(key))
    onlooker.watch_alive("muster/v1/*/alive", lambda key, _: tokens.append(key))
    publish_until_received(site, unit, "anna")
    until(lambda: POSITION.key("anna") in seen and tokens == [alive_key("anna")], "what happens")
    say_forged(onlooker, COMMAND.key("anna"))
    say_forged(onlooker, POSITION.key("anna"))
    assert list(onlooker.query("muster/v1/anna/journal/range", b"", QUIET_S)) == []
    time.sleep(QUIET_S)
    assert commands == []
    assert b"forged" not in {payload for _, payload in site.received}
    token.close()
