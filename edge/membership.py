"""Who a unit is, and which station it belongs to: from its enrolment, or from the settings."""

from __future__ import annotations

import re
from dataclasses import dataclass

from edge.config import EdgeConfig
from shared.channels import validate_unit_id
from shared.errors import ConfigError
from shared.tls import TlsIdentity

_ENDPOINT = re.compile(r"(tcp|tls)/(\[[0-9A-Fa-f:.]+\]|[^\s/:]+):([0-9]{1,5})")
_NEAREST_STATION = "tcp/127.0.0.1:7447"


@dataclass(frozen=True, slots=True)
class Membership:
    unit_id: str
    connect: tuple[str, ...]
    identity: TlsIdentity | None  # None: the link is not secured


def membership(config: EdgeConfig) -> Membership:
    """Raises ConfigError where the settings contradict each other or leave something open."""
    if config.enrolment is None:
        if not config.unit:
            raise ConfigError(
                "the unit has no name: give --unit, or --enrolment with the file that the station "
                "made for it"
            )
        found = Membership(
            validate_unit_id(config.unit), config.connect or (_NEAREST_STATION,), None
        )
    else:
        found = _enrolled(config)
    for endpoint in found.connect:
        _check_endpoint(endpoint, secured=found.identity is not None)
    return found


def _enrolled(config: EdgeConfig) -> Membership:
    from shared.enrolment import Holder, read_enrolment  # noqa: PLC0415  # slow to load

    assert config.enrolment is not None
    enrolment = read_enrolment(config.enrolment)
    if enrolment.holder is not Holder.UNIT:
        raise ConfigError(
            f"{config.enrolment} enrols the {enrolment.holder.value} {enrolment.name}, not a unit"
        )
    if config.unit not in ("", enrolment.name):
        raise ConfigError(
            f"{config.enrolment} enrols unit {enrolment.name}, not {config.unit}; leave the name "
            "out or take the right file"
        )
    return Membership(
        validate_unit_id(enrolment.name), config.connect or enrolment.connect, enrolment.identity
    )


def _check_endpoint(endpoint: str, *, secured: bool) -> None:
    parts = _ENDPOINT.fullmatch(endpoint)
    if parts is None or not 0 < int(parts[3]) < 65536:
        raise ConfigError(
            f"{endpoint!r} is no place to connect to; write tcp/HOST:PORT, or tls/HOST:PORT with "
            "an enrolment"
        )
    if secured != (parts[1] == "tls"):
        raise ConfigError(
            f"{endpoint}: a unit that is enrolled connects with tls/ only"
            if secured
            else f"{endpoint}: a secure link needs the unit's enrolment; give --enrolment FILE"
        )
