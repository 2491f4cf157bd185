"""Bans of units whose token comes and goes without end: each ban is longer, and reported."""

from __future__ import annotations

from base_station.engine.liveness import CHANGES_AT_ONCE, LivenessMonitor
from base_station.engine.sender_bans import FIRST_S, LONGEST_S, SenderBans
from shared.bus_memory import MemoryRouter
from shared.channels import alive_key
from shared.clock import ManualClock

WHY = "does harm"


class Watch:
    """Orders of bans, and the state of a log."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.orders: list[tuple[str, float]] = []
        self.known: dict[str, str] = {}
        self.start()

    def start(self) -> None:
        """Start again, with the state of the log."""
        self.bans = SenderBans(lambda who, s: self.orders.append((who, s)), self.clock)

    def changes(self) -> list[tuple[str, str]]:
        reports = [(one.part, one.text) for one in self.bans.changes(self.known)]
        self.known = {k: v for k, v in (self.known | dict(reports)).items() if v}
        return reports


def test_each_ban_is_longer_and_a_quiet_hour_resets_it() -> None:
    watch = Watch()
    for _ in range(6):
        watch.bans.ban("evil", WHY)
        watch.clock.advance(watch.orders[-1][1] + 1.0)
    assert [seconds for _, seconds in watch.orders] == [60.0, 240.0, 960.0, 3600.0, 3600.0, 3600.0]
    assert watch.orders[-1][1] == LONGEST_S
    watch.clock.advance(3601.0)
    watch.bans.ban("evil", WHY)
    assert watch.orders[-1] == ("evil", FIRST_S)


def test_events_in_transit_order_no_further_ban() -> None:
    watch = Watch()
    for _ in range(1000):
        watch.bans.ban("evil", WHY)
    assert watch.orders == [("evil", FIRST_S)]
    watch.clock.advance(2.0)  # a router that had just ended received nothing of it
    watch.bans.ban("evil", WHY)
    assert watch.orders == [("evil", FIRST_S)] * 2


def test_ban_is_reported_by_name_and_so_is_its_end() -> None:
    watch = Watch()
    watch.bans.ban("evil", WHY)
    [(part, text)] = watch.changes()
    assert "evil does harm: it is shut out for 1 min" in text
    assert "muster pki revoke evil" in text
    assert watch.changes() == []
    watch.clock.advance(FIRST_S + 31.0)
    assert watch.changes() == [(part, "")]
    assert watch.changes() == []


def test_ban_reported_by_an_earlier_run_ends() -> None:
    watch = Watch()
    watch.bans.ban("evil", WHY)
    [(part, _)] = watch.changes()
    watch.start()
    assert watch.changes() == [(part, "")]


def test_only_a_unit_whose_token_comes_and_goes_without_end_is_banned() -> None:
    router, clock = MemoryRouter(), ManualClock()
    ban: list[str] = []
    links = LivenessMonitor(router.attach_station(), lambda who, _: ban.append(who), clock)
    unit = router.attach_unit()
    anna = unit.declare_alive(alive_key("anna"))
    for _ in range(600):  # a link that comes and goes every other second, for twenty minutes
        anna.close()
        anna = unit.declare_alive(alive_key("anna"))
        clock.advance(2.0)
    assert ban == []
    for _ in range(round(CHANGES_AT_ONCE)):
        unit.declare_alive(alive_key("evil")).close()
    assert set(ban) == {"evil"}
    assert links.linked == {"anna"}
    assert links.unlinked == {"evil"}
    clock.advance(60.0)
    evil = unit.declare_alive(alive_key("evil"))
    assert links.linked == {"anna", "evil"}
    for token in (anna, evil):
        token.close()
