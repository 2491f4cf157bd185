"""Who may do what on the bus, over real Zenoh: certificates, access rules, revocation."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path

import pytest
from cryptography import x509

from base_station.pki.access import access_control
from base_station.pki.folder import PkiFolder
from shared.bus_zenoh import ClientEndpoint, StationEndpoint, UnitEndpoint, ZenohBus
from shared.channels import (
    COMMAND,
    DESCRIPTION,
    EVERY_UNIT,
    GPS,
    IMU,
    POSITION,
    Qos,
    alive_key,
    clock_key,
    tracker_id,
)
from shared.enrolment import Enrolment, Holder
from shared.errors import BusError
from shared.tls import TlsIdentity

# Long enough for what is allowed to have arrived twice over: what is forbidden must not have.
QUIET_S = 0.7


def until(holds: Callable[[], bool], what: str) -> None:
    deadline = time.monotonic() + 20.0
    while not holds():
        assert time.monotonic() < deadline, f"never came: {what}"
        time.sleep(0.01)


class Site:
    """A router with the rules of an authority, and the station as its client."""

    def __init__(self, data: Path, stack: ExitStack) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.address = f"127.0.0.1:{port}"
        self.unnamed_address = f"127.0.0.2:{port}"  # its certificate does not stand for it
        self.pki = PkiFolder(data)
        self.pki.create("Test", hosts=[], connect=[f"tls/{self.address}"])
        self._stack = stack
        self.heard: list[tuple[str, bytes]] = []
        self.alive: set[str] = set()

    def open(self) -> None:
        """After everyone is enrolled: rules are read when the router opens."""
        self.router = self._open_router()
        self.station = self.join(
            ClientEndpoint((f"tls/{self.address}",), self.pki.station_identity())
        )
        self.station.subscribe("muster/v1/**", lambda k, p: self.heard.append((k, p)))
        self.station.watch_alive("muster/v1/**", self._token)

    def reopen(self) -> None:
        self.router.close()
        self.router = self._open_router()

    def _open_router(self) -> ZenohBus:
        router = ZenohBus(
            StationEndpoint(
                (f"tls/{self.address}", f"tls/{self.unnamed_address}"),
                self.pki.station_identity(),
                access_control(self.pki.registry()),
            )
        )
        self._stack.callback(router.close)
        return router

    def join(self, endpoint: UnitEndpoint | ClientEndpoint) -> ZenohBus:
        bus = ZenohBus(endpoint)
        self._stack.callback(bus.close)
        return bus

    def unit(self, enrolment: Enrolment) -> ZenohBus:
        return self.join(UnitEndpoint(enrolment.connect, enrolment.identity))

    def heard_under(self, key: str) -> list[bytes]:
        return [payload for heard, payload in self.heard if heard == key]

    def _token(self, key: str, alive: bool) -> None:
        (self.alive.add if alive else self.alive.discard)(key)


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    with ExitStack() as stack:
        yield Site(tmp_path, stack)


def publish_until_heard(site: Site, unit: ZenohBus, unit_id: str) -> None:
    key = POSITION.key(unit_id)
    before = len(site.heard_under(key))

    def arrived() -> bool:
        unit.publish(key, b"here", Qos.LIVE)
        return len(site.heard_under(key)) > before

    until(arrived, f"a message of {unit_id}")


def test_an_enrolled_unit_speaks_lives_hears_its_commands_and_answers(site: Site) -> None:
    enrolment = site.pki.enroll("anna")
    site.open()
    unit = site.unit(enrolment)
    commands: list[tuple[str, bytes]] = []
    for name in ("anna", EVERY_UNIT):
        unit.subscribe(COMMAND.key(name), lambda k, p: commands.append((k, p)))
    token = unit.declare_alive(alive_key("anna"))
    unit.serve("muster/v1/anna/journal/**", lambda *_: [b"entry"])
    publish_until_heard(site, unit, "anna")
    until(lambda: site.alive == {alive_key("anna")}, "the token")
    for name in ("anna", EVERY_UNIT):
        key = COMMAND.key(name)
        until(partial(site.station.is_heard, key), "the unit's interest")
        site.station.publish(key, b"leave", Qos.ALERT)
    until(lambda: len(commands) == 2, "both commands")

    def answered() -> bool:
        return list(site.station.query("muster/v1/anna/journal/range", b"", 2.0)) == [b"entry"]

    until(answered, "the journal's answer")
    token.close()
    until(lambda: site.alive == set(), "the end of the token")


def test_a_unit_can_do_nothing_in_anothers_name(site: Site) -> None:
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
    publish_until_heard(site, unit, "anna")
    publish_until_heard(site, other, "bert")
    until(lambda: site.station.is_heard(COMMAND.key("bert")), "bert's interest")
    forged = (
        POSITION.key("bert"),
        COMMAND.key("bert"),
        COMMAND.key("anna"),
        COMMAND.key(EVERY_UNIT),
        "muster/v1/station/tick",
    )
    for key in forged:
        unit.publish(key, b"forged", Qos.ALERT)
    site.station.publish(COMMAND.key("bert"), b"true", Qos.ALERT)
    until(lambda: commanded == [b"true"], "the true command")
    publish_until_heard(site, other, "bert")
    assert b"forged" not in {payload for _, payload in site.heard}
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


def test_a_tracking_agent_hears_its_units_raw_stream_and_speaks_as_itself_only(site: Site) -> None:
    anna, bert = site.pki.enroll("anna"), site.pki.enroll("bert")
    enrolment = site.pki.enroll("anna", Holder.TRACKER)
    site.open()
    units = {"anna": site.unit(anna), "bert": site.unit(bert)}
    ears = site.join(ClientEndpoint(enrolment.connect, enrolment.identity))
    bystander = site.join(ClientEndpoint(bert.connect, bert.identity))
    heard: list[str] = []
    overheard: list[str] = []
    for expression in ("muster/v1/**", IMU.key("anna"), DESCRIPTION.key("anna"), IMU.key("bert")):
        ears.subscribe(expression, lambda key, _: heard.append(key))
        bystander.subscribe(expression, lambda key, _: overheard.append(key))

    def raw_is_heard() -> bool:
        for name, unit in units.items():
            for channel in (IMU, DESCRIPTION, GPS, POSITION):
                unit.publish(channel.key(name), b"of " + name.encode(), Qos.LIVE)
        return {IMU.key("anna"), DESCRIPTION.key("anna")} <= set(heard)

    until(raw_is_heard, "the raw stream")
    mouth = site.unit(enrolment)
    publish_until_heard(site, mouth, tracker_id("anna"))
    time.sleep(QUIET_S)
    assert set(heard) == {IMU.key("anna"), DESCRIPTION.key("anna")}
    assert IMU.key("anna") not in overheard
    token = mouth.declare_alive(alive_key("anna"))
    mouth.serve("muster/v1/anna/journal/**", lambda *_: [b"forged"])
    for key in (POSITION.key("anna"), POSITION.key(tracker_id("bert")), COMMAND.key("anna")):
        mouth.publish(key, b"forged", Qos.ALERT)
    units["bert"].publish(POSITION.key(tracker_id("anna")), b"forged", Qos.ALERT)
    units["anna"].publish(POSITION.key(tracker_id("anna")), b"forged", Qos.ALERT)
    publish_until_heard(site, mouth, tracker_id("anna"))
    publish_until_heard(site, units["bert"], "bert")
    time.sleep(QUIET_S)
    assert b"forged" not in {payload for _, payload in site.heard}
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


def test_a_unit_is_told_the_time_under_its_own_key_only(site: Site) -> None:
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


def test_a_revoked_unit_is_out_once_the_router_reopens(site: Site) -> None:
    anna, bert = site.pki.enroll("anna"), site.pki.enroll("bert")
    site.open()
    lost, kept = site.unit(anna), site.unit(bert)
    publish_until_heard(site, lost, "anna")
    site.pki.revoke("anna")
    site.reopen()
    publish_until_heard(site, kept, "bert")
    until(lost.is_linked, "the lost unit's link")
    assert_speechless(site, lost, "anna")


def test_the_stolen_certificate_stays_out_when_the_name_is_enrolled_again(site: Site) -> None:
    stolen = site.pki.enroll("anna")
    site.pki.revoke("anna")
    again = site.pki.enroll("anna")
    site.open()
    assert_powerless(site, stolen)
    publish_until_heard(site, site.unit(again), "anna")


def test_a_renewed_and_the_old_certificate_both_work(site: Site) -> None:
    old = site.pki.enroll("anna")
    new = site.pki.renew("anna")
    site.open()
    publish_until_heard(site, site.unit(old), "anna")
    publish_until_heard(site, site.unit(new), "anna")


def test_an_operator_hears_and_says_nothing(site: Site) -> None:
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
    publish_until_heard(site, unit, "anna")
    until(lambda: POSITION.key("anna") in seen and tokens == [alive_key("anna")], "what happens")
    onlooker.publish(COMMAND.key("anna"), b"forged", Qos.ALERT)
    onlooker.publish(POSITION.key("anna"), b"forged", Qos.ALERT)
    assert list(onlooker.query("muster/v1/anna/journal/range", b"", QUIET_S)) == []
    time.sleep(QUIET_S)
    assert commands == []
    assert b"forged" not in {payload for _, payload in site.heard}
    token.close()


def test_a_certificate_that_has_ended_is_refused(site: Site, tmp_path: Path) -> None:
    year_ago = PkiFolder(tmp_path, lambda: datetime.now(UTC) - timedelta(days=366))
    expired = year_ago.enroll("anna", valid=timedelta(days=300))
    site.open()
    assert_never_linked(site, UnitEndpoint(expired.connect, expired.identity))


def test_a_link_ends_with_its_certificate(site: Site) -> None:
    enrolment = site.pki.enroll("anna", valid=timedelta(seconds=4))
    site.open()
    unit = site.unit(enrolment)
    publish_until_heard(site, unit, "anna")
    until(lambda: datetime.now(UTC) > ends(enrolment), "the end of the certificate")
    until(lambda: not unit.is_linked(), "the end of the link")
    site.heard.clear()
    unit.publish(POSITION.key("anna"), b"late", Qos.LIVE)
    time.sleep(QUIET_S)
    assert site.heard == []


def test_a_certificate_of_another_authority_is_refused(site: Site, tmp_path: Path) -> None:
    elsewhere = PkiFolder(tmp_path / "elsewhere")
    elsewhere.create("Test", hosts=[], connect=[f"tls/{site.address}"])
    foreign = elsewhere.enroll("anna")
    own = site.pki.enroll("anna")
    site.open()
    assert_never_linked(site, UnitEndpoint(foreign.connect, foreign.identity))
    # It trusts the station, but is not of its authority.
    mixed = TlsIdentity(
        own.identity.authority, foreign.identity.certificate, foreign.identity.private_key
    )
    assert_never_linked(site, UnitEndpoint(own.connect, mixed))


def test_a_station_of_another_authority_is_refused_by_the_unit(site: Site, tmp_path: Path) -> None:
    elsewhere = PkiFolder(tmp_path / "elsewhere")
    elsewhere.create("Test", hosts=[], connect=[f"tls/{site.address}"])
    foreign = elsewhere.enroll("anna")
    own = site.pki.enroll("anna")
    site.open()
    trusting_another = TlsIdentity(
        foreign.identity.authority, own.identity.certificate, own.identity.private_key
    )
    assert_never_linked(site, UnitEndpoint(own.connect, trusting_another))


def test_a_unit_that_asks_for_the_station_by_a_wrong_name_stays_out(site: Site) -> None:
    own = site.pki.enroll("anna")
    site.open()
    assert_never_linked(site, UnitEndpoint((f"tls/{site.unnamed_address}",), own.identity))


def test_plain_tcp_is_refused(site: Site) -> None:
    site.pki.enroll("anna")
    site.open()
    assert_never_linked(site, UnitEndpoint((f"tcp/{site.address}",)))


def test_a_client_without_a_certificate_is_refused(site: Site) -> None:
    import ssl  # noqa: PLC0415  # Zenoh itself will not open without one

    site.open()
    context = ssl.create_default_context(
        cadata=site.pki.station_identity().authority.decode("ascii")
    )
    host, _, port = site.address.partition(":")
    with (
        socket.create_connection((host, int(port)), 5.0) as plain,
        context.wrap_socket(plain, server_hostname=host) as secured,
        pytest.raises(ssl.SSLError, match="CERTIFICATE_REQUIRED"),
    ):
        secured.recv(1)


def test_a_station_whose_router_is_away_says_where_it_looked(site: Site) -> None:
    endpoint = ClientEndpoint((f"tls/{site.address}",), site.pki.station_identity(), patience_s=0.3)
    with pytest.raises(BusError, match=site.address):
        ZenohBus(endpoint)


def ends(enrolment: Enrolment) -> datetime:
    certificate = x509.load_pem_x509_certificate(enrolment.identity.certificate)
    return certificate.not_valid_after_utc


def assert_powerless(site: Site, enrolment: Enrolment) -> None:
    """Linked, and yet nothing goes either way."""
    unit = site.unit(enrolment)
    until(unit.is_linked, "the link")
    assert_speechless(site, unit, enrolment.name)


def assert_speechless(site: Site, unit: ZenohBus, name: str) -> None:
    site.heard.clear()
    heard: list[str] = []
    unit.subscribe(COMMAND.key(name), lambda key, _: heard.append(key))
    token = unit.declare_alive(alive_key(name))
    unit.serve(f"muster/v1/{name}/journal/**", lambda *_: [b"forged"])
    deadline = time.monotonic() + QUIET_S
    while time.monotonic() < deadline:
        unit.publish(POSITION.key(name), b"forged", Qos.LIVE)
        site.station.publish(COMMAND.key(name), b"secret", Qos.ALERT)
        time.sleep(0.02)
    assert not unit.is_heard(POSITION.key(name))
    assert list(site.station.query(f"muster/v1/{name}/journal/range", b"", 0.5)) == []
    assert site.heard_under(POSITION.key(name)) == []
    assert heard == []
    assert site.alive == set()
    token.close()


def assert_never_linked(site: Site, endpoint: UnitEndpoint) -> None:
    unit = site.join(endpoint)
    deadline = time.monotonic() + QUIET_S
    while time.monotonic() < deadline:
        unit.publish(POSITION.key("anna"), b"forged", Qos.LIVE)
        assert not unit.is_linked()
        time.sleep(0.02)
    assert site.heard == []
