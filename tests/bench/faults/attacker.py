"""Somebody on the bus who does harm: a program of its own, as it is in the network of the units.

python -m tests.bench.faults.attacker WHAT MEMBERSHIP NAMES LOG SECONDS
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import msgspec

from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import CHANNELS, POSITION, Direction, Qos, is_backfilled, parse_key
from shared.clock import NS_PER_S, SystemClock
from shared.codec import decode, encode
from shared.enrolment import read_enrolment
from shared.errors import MusterError
from shared.mcap_log import read_log
from shared.messages import Header
from tests.rig import message_factory
from tests.rig.fuzz import mutated, random_payload
from tests.rig.pacing import paced

FORGED_BOOT = 0xBAD  # the run that says what its unit never said
_RATE_HZ = 1000.0
_DAY_NS = 86_400 * NS_PER_S

Record = tuple[str, bytes]  # key, payload


def forge(names: list[str], _log: Path, _chance: random.Random) -> Iterator[Record]:
    """Positions of units, as if they had said them."""
    clock = SystemClock()
    seq = 0
    while True:
        seq += 1
        for name in names:
            header = Header(name, FORGED_BOOT, seq, clock.monotonic_ns(), clock.utc_ns())
            yield POSITION.key(name), encode(message_factory.position(header))


def repeat(names: list[str], log: Path, chance: random.Random) -> Iterator[Record]:
    """Replays recorded messages of the units: in any order, many times, and of another day."""
    known = [
        (key, payload)
        for _, key, payload in read_log(log)
        if "/up/" in key and not is_backfilled(key) and parse_key(key)[0] in names
    ]
    while True:
        key, payload = chance.choice(known)
        yield key, payload
        message = decode(parse_key(key)[1], payload)
        header = msgspec.structs.replace(message.header, t_utc_ns=message.header.t_utc_ns - _DAY_NS)
        yield key, encode(msgspec.structs.replace(message, header=header))


def babble(names: list[str], _log: Path, chance: random.Random) -> Iterator[Record]:
    """Payloads that make no sense, on every channel."""
    channels = [one for one in CHANNELS if one.direction is Direction.UP]
    seq = 0
    while True:
        seq += 1
        channel, name = chance.choice(channels), chance.choice(names)
        yield channel.key(name), mutated(chance, random_payload(chance, channel, name, seq))


WHAT: dict[str, Callable[[list[str], Path, random.Random], Iterator[Record]]] = {
    "forge": forge,
    "repeat": repeat,
    "babble": babble,
}


def endpoint_of(membership: str) -> UnitEndpoint:
    """By an enrolment, or of who has none an address."""
    if membership.startswith("tcp/"):
        return UnitEndpoint((membership,))
    enrolment = read_enrolment(Path(membership))
    return UnitEndpoint(enrolment.connect, enrolment.identity)


def meddle(what: str, membership: str, names: str, log: str, seconds: str) -> None:
    """Says what it can, whether anybody listens or not."""
    records = WHAT[what](names.split(","), Path(log), random.Random(what))  # no secret
    with closing(ZenohBus(endpoint_of(membership))) as bus:
        for _ in paced(_RATE_HZ, float(seconds)):
            bus.publish(*next(records), Qos.LIVE)


if __name__ == "__main__":
    try:
        meddle(*sys.argv[1:])
    except MusterError as error:
        sys.exit(str(error))
